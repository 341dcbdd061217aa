"""Random ground commands from a seed: sequences that build on each other, single commands, damaged packets.

A step goes up at once, to one service, and is answered before the next. Commands that would cut the link itself are
left out: resets, the end of CI_LAB, TO_LAB or SCH_LAB, their routes, other addresses for telemetry, tones from the
ground. `lives` makes such steps.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from random import Random
from typing import Any, NamedTuple

from apps import ci_lab, sample_app, to_lab
from cfepy import msg
from cfepy.es import packets as es
from cfepy.evs import packets as evs
from cfepy.msg import Command
from cfepy.sb import packets as sb
from cfepy.tbl import packets as tbl
from cfepy.time import packets as time

PLAIN, BACKGROUND, CONTROL, RESET = "plain", "background", "control", "reset"
"""How long a step takes: the answer of a task; a file in the background, or a start; the end of an application; a boot,
after which the question for housekeeping comes."""

SERVICES: dict[str, tuple[Command, ...]] = {
    "ES": es.COMMANDS,
    "EVS": evs.COMMANDS,
    "SB": sb.COMMANDS,
    "TBL": tbl.COMMANDS,
    "TIME": time.COMMANDS,
    "SAMPLE_APP": sample_app.COMMANDS,
    "CI_LAB": ci_lab.COMMANDS,
    "TO_LAB": to_lab.COMMANDS,
}
WEIGHTS = {"ES": 6, "EVS": 6, "SB": 4, "TBL": 5, "TIME": 4, "SAMPLE_APP": 2, "CI_LAB": 1, "TO_LAB": 1}
HOUSEKEEPING = {
    name: next(each for each in commands if each.name.endswith("SEND_HK")) for name, commands in SERVICES.items()
}
LINK_APPS = ("CI_LAB", "TO_LAB", "SCH_LAB")
APPS = ("SAMPLE_APP", "CFE_ES", "CFE_EVS", "CFE_SB", "CFE_TBL", "CFE_TIME", *LINK_APPS)
NAMES = (
    *APPS,
    "SAMPLE_LIB",
    "NOBODY",
    "",
    "X" * 19,
    "X" * 20,
    "sample_app",
    "SAMPLE_APP ",
    b"SAMPLE\xff\xfe",
    b"\x80" * 20,
)
TABLES = (
    *("SAMPLE_APP.ExampleTable", "TO_LAB.TO_LAB_Subs", "SCH_LAB.ScheduleTable", "CFE_TBL.CritReg", "NO.Table"),
    *("", "SAMPLE_APP.ExampleTabl", "T" * 39, "T" * 40, b"SAMPLE_APP.\xe9", "SAMPLE_APP"),
)
CDS_NAMES = ("SAMPLE_APP.X", "CFE_TBL.CritReg", "CFE_TBL.Tbl_Crit_Reg", "", "A.B", "N" * 39, "N" * 40, b"\xff.\xff")
DUMPS = (
    *("/ram/a.log", "/ram/b.dat", "a", "b.x", "", "/ram", "/ram/", "/nowhere/x", "/cf/new.log", ".hidden", "dir/x"),
    *("/ram/" + "y" * 40, "/ram/" + "y" * 58, "z" * 63, "z" * 64, "/ram/" + "w" * 14, "/ram/" + "w" * 15),
    *("//ram//c.log", "/ram/d..log", "/ram/e.", "ram/f", "/", ".", b"/ram/\xe9.log", b"\xff\xff", "/ram/g h.log"),
)
MODULES = ("sample_app", "/cf/sample_app.so", "nothing", "", "/cf/sample_lib.so", "m" * 63, "m" * 64, b"\xff", "/ram/x")
GOOD_TABLE, BAD_TABLE, SHORT_TABLE = "/cf/good.tbl", "/cf/bad.tbl", "/cf/short.tbl"
LOADS = (
    *(each for each in DUMPS if each not in ("/ram", "/ram/", "/", ".")),
    GOOD_TABLE,
    BAD_TABLE,
    SHORT_TABLE,
    "/cf/part.tbl",
    "/cf/other.tbl",
    "/cf/sample_app_tbl.tbl",
)
NUMBERS = (0, 1, 2, 3, 4, 5, 8, 14, 15, 16, 64, 127, 128, 255, 256, 1000, 0x7FFF, 0x8000, 0xFFFF, 999_999, 1_000_000)
LARGE = (0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x80000001)
MSG_IDS = (0x1806, 0x1808, 0x1801, 0x1882, 0x1883, 0x1803, 0x0808, 0x0800, 0x1804, 0x180C, 0x1FFF, 0x2000, 0, 1, 0x18FF)
CORE_PIPES = tuple(0x160001 + number for number in range(5))
PIPES = (*CORE_PIPES, *CORE_PIPES, 0x160000, 0, 0x160040, 0xFFFFFFFF, 0x170001, 5)
EVENT_IDS = (1, 3, 4, 7, 14, 17, 25, 0, 0xFFFF, 20, 2)
MOST_AT_ONCE = 3  # with the request for housekeeping; a pipe takes 4 packets of a MsgId
TONES = (0x1810, 0x1811, 0x1860, 0x1862)


class Step(NamedTuple):
    """Packets that go up at once, the service that gets them, and how long their effects take."""

    service: str
    packets: tuple[bytes, ...]
    pace: str


def pace_of(packet: bytes) -> str:
    """How long a command takes."""
    msg_id, code = int.from_bytes(packet[:2], "big"), packet[6] & 0x7F if len(packet) > 6 else 0
    if msg_id == es.CMD_MID and code in (5, 6, 7, 15):
        return CONTROL
    background = {es.CMD_MID: (4, 13), sb.CMD_MID: (3, 7, 8), tbl.CMD_MID: (3, 4, 5, 6)}
    return BACKGROUND if code in background.get(msg_id, ()) else PLAIN


def is_safe(packet: bytes) -> bool:
    """Return whether a datagram leaves the link and its clock intact."""
    msg_id, code = int.from_bytes(packet[:2], "big"), packet[6] & 0x7F if len(packet) > 6 else 0
    if msg_id in TONES or (msg_id == to_lab.packets.CMD_MID and code in (2, 4, 5, 6)):
        return False
    if msg_id == es.CMD_MID and code in (4, 5, 6, 7):
        return not any(name.encode() in packet for name in LINK_APPS)
    if msg_id == es.CMD_MID and code == es.RESTART.code:
        return packet[8:10] not in (b"\1\0", b"\2\0")
    if msg_id == sb.CMD_MID and code in (4, 5):
        pipe = int.from_bytes(packet[12:16], "little")
        return pipe >> 16 != 0x16 or pipe in (*CORE_PIPES, 0x160000, 0x160040)
    return msg_id != ci_lab.packets.READ_UPLINK.msg_id


def _joined(steps: Iterable[Step]) -> Iterator[Step]:
    """Steps that follow one another go up at once, as far as one service takes them and none takes long."""
    waiting: Step | None = None
    for step in steps:
        if waiting is not None and _go_together(waiting, step):
            waiting = waiting._replace(packets=(*waiting.packets, *step.packets))
            continue
        if waiting is not None:
            yield waiting
        waiting = step
    if waiting is not None:
        yield waiting


def _go_together(one: Step, other: Step) -> bool:
    if one.service != other.service or {one.pace, other.pace} != {PLAIN}:
        return False
    last = one.packets[-1]
    return len(one.packets) < MOST_AT_ONCE and not _asks_housekeeping(last) and not _cuts_a_route(last)


def _cuts_a_route(packet: bytes) -> bool:
    """Return whether SB may get no commands after this one.

    Chance decides which commands of the same step still arrive.
    """
    is_command = len(packet) > 6 and int.from_bytes(packet[:2], "big") == sb.CMD_MID
    return is_command and packet[6] & 0x7F == sb.DISABLE_ROUTE.code


def _asks_housekeeping(packet: bytes) -> bool:
    return any(int.from_bytes(packet[:2], "big") == each.msg_id for each in HOUSEKEEPING.values())


def _all() -> Iterator[Command]:
    for commands in SERVICES.values():
        yield from commands


class Commander:
    """Makes the steps of a flight.

    Args:
        seed: of the flight.
        without: names of commands that are left out.
    """

    def __init__(self, seed: int, without: Iterable[str] = ()) -> None:
        self._random = Random(seed)
        self._left_out = {(each.msg_id, each.code) for each in _all() if each.name in set(without)}
        self._sequences: tuple[Callable[[], Iterator[tuple[str, bytes]]], ...] = (
            *(self._filters, self._types, self._formats, self._routes, self._tables, self._lifecycle, self._logs),
            *(self._perf, self._clock, self._modes),
        )

    def steps(self) -> Iterator[Step]:
        """Steps without an end."""
        for step in self._endless():
            packets = tuple(each for each in step.packets if not self._is_left_out(each))
            if packets:
                yield step._replace(packets=packets)

    def _is_left_out(self, packet: bytes) -> bool:
        return len(packet) > 6 and (int.from_bytes(packet[:2], "big"), packet[6] & 0x7F) in self._left_out

    def _endless(self) -> Iterator[Step]:
        while True:
            kind = self._random.random()
            if kind < 0.45:
                sequence = self._random.choice(self._sequences)
                yield from _joined(Step(service, (packet,), pace_of(packet)) for service, packet in sequence())
            else:
                yield self._burst(damaged=kind > 0.8)

    def _burst(self, damaged: bool) -> Step:
        service = self._random.choices([*WEIGHTS], [*WEIGHTS.values()])[0]
        packets: list[bytes] = []
        count = self._random.choice((1, 2, 3, 3))
        if damaged and service == "EVS":
            count = 1  # an event of CI_LAB about the next packet would race with EVS's command about events
        while len(packets) < count:
            packet = self._any(service)
            if damaged:
                packet = self._damage(packet)
            if packets and _asks_housekeeping(packets[-1]):
                packets.pop()  # its answer would race with CI_LAB, which continues with the next packet
            if is_safe(packet):
                packets.append(packet)
        alone = next((packet for packet in packets if pace_of(packet) != PLAIN or _cuts_a_route(packet)), None)
        packets = packets if alone is None else [alone]
        return Step(service, tuple(packets), pace_of(packets[0]))

    def _any(self, service: str) -> bytes:
        return self._filled(self._random.choice(SERVICES[service]))

    def _filled(self, command: Command, **values: Any) -> bytes:
        payload = bytearray(command.payload.size)
        for cell in command.payload.cells():
            value = self._value(command, cell.path, cell.type, cell.size)
            payload[cell.offset : cell.offset + cell.size] = value
        for name, value in values.items():
            at, size = command.payload.offsets[name], command.payload.sizes[name]
            given = value.to_bytes(size, "little") if isinstance(value, int) else value.encode().ljust(size, b"\0")
            payload[at : at + size] = given
        return bytes(msg.command(command.msg_id, command.code or 0, bytes(payload)))

    def _value(self, command: Command, path: str, kind: str, size: int) -> bytes:
        random = self._random
        if not kind.startswith("char"):
            return self._number(path).to_bytes(8, "little")[:size]
        field = path.lower()
        texts: tuple[str | bytes, ...] = NAMES
        if "file" in field:
            texts = MODULES if "app" in field and "data" not in field else DUMPS
            texts = LOADS if command is tbl.LOAD else texts
        elif "table" in field:
            texts = TABLES
        elif "cds" in field:
            texts = CDS_NAMES
        elif "entry" in field:
            texts = ("SAMPLE_APP_Main", "", "Nothing", "S" * 19, "S" * 20)
        text = random.choice(texts) if random.random() < 0.97 else random.randbytes(size).translate(None, b"/.")
        data = text.encode() if isinstance(text, str) else text
        data = data[:size].ljust(size, b"\0")
        if random.random() < 0.05:
            name, _, rest = data.partition(b"\0")
            tail = random.randbytes(len(rest)).translate(None, b"/.")  # why not these: docs/reference/differences.md
            data = (name + b"\0" + tail).ljust(size, b"\0")[:size]
        return data

    def _number(self, path: str) -> int:
        random = self._random
        choices = {"Pipe": PIPES, "MsgId": MSG_IDS, "EventID": EVENT_IDS, "Stream": MSG_IDS}
        if path in choices:
            return random.choice(choices[path])
        if path == "BitMask" and random.random() < 0.7:
            return random.randrange(1, 16)
        if random.random() < 0.4:
            return random.randrange(4)
        return random.choice((*NUMBERS, *LARGE, random.getrandbits(32)))

    def _damage(self, packet: bytes) -> bytes:
        random, data = self._random, bytearray(packet)
        for _ in range(random.choice((1, 1, 2))):
            kind = random.randrange(7)
            if kind == 0:  # a payload of another length, with a matching header
                size = max(8, len(data) + random.choice((-8, -2, -1, 1, 2, 8, 100)))
                data = (data + random.randbytes(120))[:size]
                data[4:6] = (size - 7).to_bytes(2, "big")
            elif kind == 1 and len(data) >= 8:  # the header gives a length that is too short or too long
                data[4:6] = max(0, len(data) - 7 + random.choice((-9, -1, 1, 3, 500))).to_bytes(2, "big")
            elif len(data) < 8:
                continue
            elif kind == 2:
                data[6] = random.choice((random.randrange(128), 0x80 | data[6], data[6] + 1 & 0xFF))
            elif kind == 3:
                data[7] = random.randrange(256)
            elif kind == 4:  # type, secondary header, version
                data[0] ^= random.choice((0x10, 0x08, 0x20, 0x80, 0x18))
            elif kind == 5:
                data[random.randrange(1, 4)] ^= 1 << random.randrange(8)
            else:
                data = data[: random.choice((0, 1, 5, 6, 7, 8, len(data)))]
        return bytes(data) or b"\0"

    # -- sequences that build on earlier commands ------------------------------------------------------------------

    def _filters(self) -> Iterator[tuple[str, bytes]]:
        app = self._random.choice(("SAMPLE_APP", "CFE_ES", "CFE_SB", "CI_LAB", "TO_LAB"))
        event, mask = self._random.choice((1, 3, 7, 18, 28)), self._random.choice((1, 3, 0xFFFE, 0xFFFF, 0))
        owner = {"CFE_ES": "ES", "CFE_SB": "SB"}.get(app, app)
        noop = SERVICES[owner][0]
        yield "EVS", self._filled(evs.ADD_EVENT_FILTER, AppName=app, EventID=event, Mask=mask)
        for _ in range(self._random.randrange(1, 4)):
            yield owner, self._filled(noop)
        for command in (evs.SET_FILTER, evs.RESET_FILTER, evs.RESET_ALL_FILTERS, evs.DELETE_EVENT_FILTER):
            if self._random.random() < 0.6:
                values = {"AppName": app, "EventID": event, "Mask": mask}
                yield "EVS", self._filled(command, **{k: v for k, v in values.items() if k in command.payload.offsets})
                yield owner, self._filled(noop)
        yield "EVS", self._filled(evs.WRITE_APP_DATA_FILE)

    def _types(self) -> Iterator[tuple[str, bytes]]:
        service = self._random.choice(("ES", "EVS", "SB", "TBL", "TIME"))
        app, mask = f"CFE_{service}", self._random.choice((1, 3, 15, 2))
        yield "EVS", self._filled(evs.ENABLE_APP_EVENT_TYPE, AppName=app, BitMask=mask)
        for _ in range(self._random.randrange(1, 5)):
            packet = self._any(service)
            if is_safe(packet):
                yield service, packet
        yield "EVS", self._filled(evs.DISABLE_APP_EVENT_TYPE, AppName=app, BitMask=self._random.choice((mask, 1)))
        yield service, self._filled(SERVICES[service][0])
        yield "EVS", self._filled(evs.ENABLE_APP_EVENT_TYPE, AppName=app, BitMask=14)

    def _formats(self) -> Iterator[tuple[str, bytes]]:
        yield "EVS", self._filled(evs.SET_EVENT_FORMAT_MODE, MsgFormat=0)
        yield "ES", self._filled(es.NOOP)
        yield "EVS", self._filled(evs.SET_EVENT_FORMAT_MODE, MsgFormat=1)

    def _routes(self) -> Iterator[tuple[str, bytes]]:
        pipe, (service, msg_id) = self._random.choice(
            [(0x160002, ("SB", sb.CMD_MID)), (0x160003, ("ES", es.CMD_MID)), (0x160001, ("EVS", evs.CMD_MID))]
        )
        yield "SB", self._filled(sb.DISABLE_ROUTE, MsgId=msg_id, Pipe=pipe)
        if service != "SB":
            yield service, self._filled(SERVICES[service][0])
        yield "SB", self._filled(sb.ENABLE_ROUTE, MsgId=msg_id, Pipe=pipe)
        yield "SB", self._filled(sb.WRITE_ROUTING_INFO, Filename="/ram/route.dat")

    def _tables(self) -> Iterator[tuple[str, bytes]]:
        table = "SAMPLE_APP.ExampleTable"
        which = self._random.randrange(2)
        if self._random.random() < 0.7:
            file = self._random.choice((GOOD_TABLE, BAD_TABLE, SHORT_TABLE, "/cf/part.tbl", "/cf/other.tbl"))
            yield "TBL", self._filled(tbl.LOAD, LoadFilename=file)
        if self._random.random() < 0.7:
            yield "TBL", self._filled(tbl.VALIDATE, TableName=table, ActiveTableFlag=which)
            yield "SAMPLE_APP", self._filled(HOUSEKEEPING["SAMPLE_APP"])
            yield "TBL", self._filled(tbl.SEND_REGISTRY, TableName=table)
        if self._random.random() < 0.5:
            yield "TBL", self._filled(tbl.ACTIVATE, TableName=table)
            yield "SAMPLE_APP", self._filled(HOUSEKEEPING["SAMPLE_APP"])
        if self._random.random() < 0.5:
            yield "TBL", self._filled(tbl.DUMP, TableName=table, ActiveTableFlag=which, DumpFilename="/ram/t.tbl")
        if self._random.random() < 0.5:
            yield "TBL", self._filled(tbl.ABORT_LOAD, TableName=table)
        yield "TBL", self._filled(tbl.DUMP_REGISTRY)

    def _lifecycle(self) -> Iterator[tuple[str, bytes]]:
        app = {"Application": "SAMPLE_APP"}
        kind = self._random.randrange(3)
        if kind == 0:
            yield "ES", self._filled(es.RESTART_APP, **app)
        elif kind == 1:
            yield "ES", self._filled(es.RELOAD_APP, **app, AppFileName=self._random.choice(("sample_app", "nothing")))
        else:
            yield "ES", self._filled(es.STOP_APP, **app)
            yield "ES", self._filled(es.QUERY_ONE, **app)
        start = {"AppEntryPoint": "SAMPLE_APP_Main", "AppFileName": "sample_app", "ExceptionAction": 0, "Priority": 70}
        yield "ES", self._filled(es.START_APP, **app, **start, StackSize=self._random.choice((0, 16384)))
        yield "ES", self._filled(es.QUERY_ONE, **app)
        yield "SAMPLE_APP", self._filled(SERVICES["SAMPLE_APP"][0])

    def _logs(self) -> Iterator[tuple[str, bytes]]:
        yield "ES", self._filled(es.OVER_WRITE_SYS_LOG, Mode=self._random.choice((0, 1)))
        yield "ES", self._filled(es.QUERY_ALL, FileName="/ram/apps.log")
        yield "ES", self._filled(es.QUERY_ALL_TASKS, FileName="/ram/tasks.log")
        yield "ES", self._filled(es.DUMP_CDS_REGISTRY, DumpFilename="/ram/cds.log")
        yield "EVS", self._filled(evs.WRITE_LOG_DATA_FILE, LogFilename="/ram/evs.log")
        yield "ES", self._filled(es.WRITE_ER_LOG, FileName="/ram/er.log")

    def _perf(self) -> Iterator[tuple[str, bytes]]:
        for command in (es.SET_PERF_FILTER_MASK, es.SET_PERF_TRIGGER_MASK, es.START_PERF_DATA):
            yield "ES", self._filled(command)
        yield "ES", self._filled(es.SET_PERF_FILTER_MASK, FilterMaskNum=0, FilterMask=0)

    def _clock(self) -> Iterator[tuple[str, bytes]]:
        for command in (time.SET_STATE, time.SET_LEAP_SECONDS, time.SET_STCF, time.ADD_ADJUST, time.SUB_ADJUST):
            if self._random.random() < 0.6:
                yield "TIME", self._filled(command)

    def _modes(self) -> Iterator[tuple[str, bytes]]:
        yield "EVS", self._filled(evs.SET_LOG_MODE, LogMode=self._random.randrange(3))
        yield "SB", self._filled(sb.WRITE_PIPE_INFO, Filename="/ram/pipes.dat")
        yield "SB", self._filled(sb.WRITE_MAP_INFO, Filename="/ram/map.dat")
        yield "SB", self._filled(sb.SEND_SB_STATS)
