"""Random steps that end applications, reset the processor, and query the remaining state; `lives_flight` flies them.

They go up through LINK (link_app.c), which stays when CI_LAB, TO_LAB or SCH_LAB end. Some go on from LINK to CI_LAB's
port, to show whether CI_LAB listens. They include ground tones, and blocks of the CDS that LINK owns.
"""

from __future__ import annotations

from collections.abc import Iterator

from apps import ci_lab, sample_app, to_lab
from cfepy import msg
from cfepy.es import packets as es
from cfepy.evs import packets as evs
from cfepy.sb import packets as sb
from cfepy.tbl import packets as tbl
from cfepy.time import packets as time
from dev.twin.commands import CONTROL, HOUSEKEEPING, LINK_APPS, RESET, Commander, Step, _joined, is_safe, pace_of
from dev.twin.link_app import REQUEST, REQUEST_MID

PROCESSOR, POWERON = 1, 2
LEFT_OUT = (to_lab.packets.OUTPUT_ENABLE.code, to_lab.packets.REMOVE_ALL_PKT.code)
"""Commands of TO_LAB: another address, and one with a fault of NASA's, see docs/reference/differences.md."""
LABS = (*LINK_APPS, "SAMPLE_APP")
BLOCKS = ("A", "STATE", "SIXTEEN_LETTERS_", "SEVENTEEN_LETTERS", "")
SIZES = (0, 1, 8, 64, 200, 5000, 65535)
NOTHING = "LINK"
"""The service of a step after which nobody is asked for housekeeping."""


def request(letter: str, slot: int = 0, size: int = 0, byte: int = 0, name: str = "") -> bytes:
    """Return a request for LINK."""
    return bytes(msg.command(REQUEST_MID, 0, REQUEST.pack(letter.encode(), slot, size, byte) + name.encode() + b"\0"))


def through_ci_lab(packet: bytes) -> bytes:
    """Return a datagram that LINK sends on to CI_LAB's port."""
    return bytes(msg.command(REQUEST_MID, 0, b"U" + packet))


class LivesCommander(Commander):
    """Makes the steps of such a flight.

    Args:
        seed: of the flight.
    """

    def __init__(self, seed: int) -> None:
        super().__init__(seed)
        self._sequences = (
            *(self._end_of_a_lab, self._end_of_a_lab, self._end_of_a_lab, self._reset, self._reset),
            *(self._tones, self._blocks, self._er_log, self._lifecycle, self._to_lab),
        )

    def _endless(self) -> Iterator[Step]:
        yield Step("TO_LAB", (to_lab.packets.OUTPUT_ENABLE.packet(dest_IP="127.0.0.1"),), CONTROL)
        while True:
            if self._random.random() < 0.85:
                sequence = self._random.choice(self._sequences)
                yield from _joined(Step(service, (packet,), _pace_of(packet)) for service, packet in sequence())
            else:
                yield self._burst(damaged=False)

    def _end_of_a_lab(self) -> Iterator[tuple[str, bytes]]:
        name = self._random.choice(LABS)
        file = name.lower()
        for _ in range(self._random.choice((1, 1, 2))):
            yield "ES", self._ended(name, file)
            yield from self._what_is_left(name)
        entry = "SAMPLE_APP_Main" if name == "SAMPLE_APP" else f"{name}_AppMain"
        start = {"AppEntryPoint": entry, "AppFileName": file, "Application": name}
        numbers = {"ExceptionAction": 0, "Priority": self._random.choice((60, 75, 200)), "StackSize": 16384}
        if self._random.random() < 0.8:
            yield "ES", self._filled(es.START_APP, **start, **numbers)
            yield from self._what_is_left(name)

    def _ended(self, name: str, file: str) -> bytes:
        kind = self._random.choice((es.RESTART_APP, es.RELOAD_APP, es.STOP_APP, es.STOP_APP))
        if kind is not es.RELOAD_APP:
            return self._filled(kind, Application=name)
        files = (file, file, f"/cf/{file}.so", "sample_app", "nothing", "/cf/sample_lib.so")
        return self._filled(kind, Application=name, AppFileName=self._random.choice(files))

    def _what_is_left(self, name: str) -> Iterator[tuple[str, bytes]]:
        yield "ES", es.QUERY_ONE.packet(Application=name)
        questions = (
            ("ES", es.QUERY_ALL.packet(FileName="/ram/apps.log")),
            ("ES", es.QUERY_ALL_TASKS.packet(FileName="/ram/tasks.log")),
            ("SB", sb.WRITE_PIPE_INFO.packet(Filename="/ram/pipes.dat")),
            ("SB", sb.WRITE_ROUTING_INFO.packet(Filename="/ram/routes.dat")),
            ("SB", sb.SEND_SB_STATS.packet()),
            ("TBL", tbl.DUMP_REGISTRY.packet(DumpFilename="/ram/tables.log")),
            ("TBL", tbl.SEND_REGISTRY.packet(TableName="SCH_LAB.ScheduleTable")),
            ("EVS", evs.WRITE_APP_DATA_FILE.packet(AppDataFilename="/ram/events.dat")),
            (NOTHING, through_ci_lab(bytes(es.NOOP.packet()))),
            ("CI_LAB", ci_lab.packets.NOOP.packet()),
            ("TO_LAB", to_lab.packets.NOOP.packet()),
            ("SAMPLE_APP", sample_app.packets.NOOP.packet()),
        )
        for service, packet in self._random.sample(questions, self._random.choice((1, 2, 3, 5))):
            yield service, bytes(packet)

    def _reset(self) -> Iterator[tuple[str, bytes]]:
        random = self._random
        before = (
            ("ES", es.SET_MAX_PR_COUNT.packet(MaxPRCount=random.choice((0, 1, 2, 3, 65535)))),
            ("ES", es.RESET_PR_COUNT.packet()),
            ("ES", es.OVER_WRITE_SYS_LOG.packet(Mode=random.choice((0, 1)))),
            ("EVS", evs.SET_LOG_MODE.packet(LogMode=random.choice((0, 1)))),
            ("EVS", evs.CLEAR_LOG.packet()),
            ("TIME", time.SET_LEAP_SECONDS.packet(LeapSeconds=random.choice((0, 37, -5, 32767)))),
            ("TIME", time.SET_STATE.packet(ClockState=random.choice((-1, 0, 1)))),
            ("TIME", time.SET_STCF.packet(Seconds=1000, MicroSeconds=5)),
            ("TIME", time.ADD_ONE_HZ_ADJUSTMENT.packet(Seconds=0, Subseconds=1)),
            ("ES", es.CLEAR_SYS_LOG.packet()),
            ("ES", es.SET_PERF_FILTER_MASK.packet(FilterMaskNum=0, FilterMask=5)),
            ("ES", es.START_PERF_DATA.packet(TriggerMode=1)),
            ("EVS", evs.DISABLE_PORTS.packet(BitMask=1)),
            ("EVS", evs.SET_EVENT_FORMAT_MODE.packet(MsgFormat=0)),
            (NOTHING, request("R", 0, 64, 0, "STATE")),
            (NOTHING, request("C", 0, 64, 0x5A)),
        )
        for service, packet in before:
            if random.random() < 0.25:
                yield service, bytes(packet)
        for kind in random.choice(((PROCESSOR,), (PROCESSOR,), (PROCESSOR, PROCESSOR), (POWERON,), (0,), (3,))):
            yield "ES", bytes(es.RESTART.packet(RestartType=kind))
            yield "EVS", evs.RESET_APP_COUNTER.packet(AppName="CFE_ES")  # its number of modules depends on the build
            yield from self._what_survived()

    def _what_survived(self) -> Iterator[tuple[str, bytes]]:
        yield "EVS", bytes(evs.SET_EVENT_FORMAT_MODE.packet(MsgFormat=1))
        questions = (
            *((service, HOUSEKEEPING[service].packet()) for service in ("EVS", "SB", "TBL", "TIME", "SAMPLE_APP")),
            ("ES", es.WRITE_ER_LOG.packet(FileName="/ram/er.log")),
            ("ES", es.WRITE_SYS_LOG.packet(FileName="/ram/sys.log")),
            ("ES", es.DUMP_CDS_REGISTRY.packet(DumpFilename="/ram/cds.log")),
            ("EVS", evs.WRITE_LOG_DATA_FILE.packet(LogFilename="/ram/evs.log")),
            ("ES", es.QUERY_ALL.packet(FileName="/ram/apps.log")),
            ("SB", sb.WRITE_ROUTING_INFO.packet(Filename="/ram/routes.dat")),
            ("TBL", tbl.DUMP_REGISTRY.packet(DumpFilename="/ram/tables.log")),
            ("TIME", time.SEND_DIAGNOSTIC.packet()),
            ("TBL", tbl.DELETE_CDS.packet(TableName="LINK.STATE")),
            ("ES", es.DELETE_CDS.packet(CdsName=self._random.choice(("LINK.STATE", "LINK.A", "CFE_TBL.CritReg")))),
        )
        for service, packet in self._random.sample(questions, self._random.choice((2, 4, 6))):
            yield service, bytes(packet)
        yield NOTHING, request("R", 0, 64, 0, "STATE")
        yield NOTHING, request("G", 0, 64)

    def _blocks(self) -> Iterator[tuple[str, bytes]]:
        for _ in range(self._random.choice((1, 2, 4))):
            slot, size = self._random.randrange(4), self._random.choice(SIZES)
            yield NOTHING, request("R", slot, size, 0, self._random.choice(BLOCKS))
            if self._random.random() < 0.7:
                yield NOTHING, request("C", slot, size, self._random.randrange(256))
            yield NOTHING, request("G", slot, size)
        yield "ES", bytes(es.DUMP_CDS_REGISTRY.packet(DumpFilename="/ram/cds.log"))

    def _er_log(self) -> Iterator[tuple[str, bytes]]:
        if self._random.random() < 0.3:
            yield "ES", bytes(es.CLEAR_ER_LOG.packet())
        yield "ES", bytes(es.WRITE_ER_LOG.packet(FileName="/ram/er.log"))
        yield "ES", bytes(es.WRITE_SYS_LOG.packet(FileName="/ram/sys.log"))

    def _to_lab(self) -> Iterator[tuple[str, bytes]]:
        for _ in range(self._random.choice((1, 2))):
            packet = self._any("TO_LAB")
            if packet[6] not in LEFT_OUT:
                yield "TO_LAB", packet
        yield "SB", bytes(sb.WRITE_ROUTING_INFO.packet(Filename="/ram/routes.dat"))

    def _tones(self) -> Iterator[tuple[str, bytes]]:
        random = self._random
        tones = (
            *(bytes(each.packet()) for each in (time.TONE_CMD, time.SEND_CMD, time.ONEHZ_CMD)),
            self._filled(time.DATA_CMD),
        )
        for _ in range(random.choice((1, 2, 3))):
            yield "TIME", random.choice(tones)
        for _ in range(random.choice((0, 1, 2))):
            packet = self._any("TIME")
            if is_safe(packet):
                yield "TIME", packet
        yield "TIME", bytes(time.SEND_DIAGNOSTIC.packet())


def _pace_of(packet: bytes) -> str:
    is_reset = packet[:2] == bytes(es.RESTART.packet()[:2]) and packet[6] & 0x7F == es.RESTART.code
    return RESET if is_reset and packet[8:10] in (b"\1\0", b"\2\0") else pace_of(packet)
