"""SCH in a mission: slots in time, commands, groups, delays, tables from the ground, and starts that fail."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import pytest

from apps.sch import SCH_AppMain
from apps.sch import packets as pk
from apps.sch.definition import activity, message_image, schedule_image
from cfepy.console import Console
from cfepy.es import APP_ERROR
from cfepy.mission import Mission
from cfepy.mission.watch import Seen, watching
from cfepy.msg import command, init
from cfepy.rtos.units import NS_PER_MS, NS_PER_S
from cfepy.status import CFE_SB_BAD_ARGUMENT, OS_ERR_INVALID_ID, CfeError, OsalError
from cfepy.tbl import TableImage, build
from cfepy.tbl import packets as tbl
from tests.apps.conftest import AppBench

FIRST, SECOND, THIRD = 0x18F1, 0x18F2, 0x18F3
MESSAGES = {1: init(FIRST, 8), 2: init(SECOND, 8), 3: command(THIRD, 5, b"\1\2"), 4: init(0x1896, 8)}
SLOTS = {
    0: [activity(1)],
    25: [activity(2, 2, 1, groups=0x02000001), activity(3, 1, 0, groups=0x02000002, enabled=False)],
    99: [activity(4)],
}

HOG = """
def Main(cfe):
    cfe.es.run_loop(1)
    cfe.os.task_delay({at_ms} - cfe.os.kernel.now // 1_000_000)
    for _ in range({busy_ms}):
        cfe.os.kernel.charge(1_000_000)
    while cfe.es.run_loop(1):
        cfe.os.task_delay(1000)
"""

HOLDER = """
def Main(cfe):
    hold, go_on = (cfe.os.symbol_lookup(name) for name in ("SCH_DisableProcessing", "SCH_EnableProcessing"))
    go_on(cfe)  # nothing to take back
    cfe.os.task_delay(3_000)
    hold(cfe)
    hold(cfe)
    cfe.os.task_delay(1_000)
    go_on(cfe)
    cfe.os.task_delay(1_000)
    go_on(cfe)
    while cfe.es.run_loop(1):
        cfe.os.task_delay(1000)
"""

SCH = "CFE_APP, sch, SCH_AppMain, SCH, 40, 16384, 0x0, 0;\n"
DEBUG_ON = command(0x1801, 5, b"SCH".ljust(20, b"\0") + b"\x0f\0")


class Flight:
    """A mission with SCH, what it sent, and an operator."""

    def __init__(self, folder: Path, board: str | None = None) -> None:
        self.seen: list[Seen] = []
        bus = watching(
            self.seen.append, lambda msg_id: msg_id in (FIRST, SECOND, THIRD, pk.HK_TLM_MID, pk.DIAG_TLM_MID)
        )
        self.mission = Mission(str(folder), board=board, console=Console(quiet=True), bus=bus)

    def send(self, *commands: bytes | bytearray) -> None:
        """Send commands from the ground."""
        for packet in commands:
            task = partial(self.mission.cfe.sb.transmit_msg, bytes(packet), False)
            self.mission.kernel.spawn("ground", task, 10)

    def run_to(self, second: float) -> None:
        """Run to a second of virtual time after the first tone of the clock."""
        self.mission.run_until(round(second * NS_PER_S))

    def events(self) -> list[str]:
        """SCH's events, each as "id: text", but the one of its start."""
        lines = [line.partition(" 66/1/SCH ")[2] for line in self.mission.console.lines]
        return [line for line in lines if line and not line.startswith("1:")]

    def times(self, msg_id: int) -> list[float]:
        """When a message was sent, in ms from the first tone."""
        tone = self.tone_ns
        return [(seen.at_ns - tone) / NS_PER_MS for seen in self.seen if seen.msg_id == msg_id]

    @property
    def tone_ns(self) -> int:
        """The virtual time of the first message of slot 0."""
        return next(seen.at_ns for seen in self.seen if seen.msg_id == FIRST)

    def housekeeping(self) -> dict[str, int]:
        """The last housekeeping packet."""
        return pk.HK_TLM.read([seen.packet for seen in self.seen if seen.msg_id == pk.HK_TLM_MID][-1])


def write_mission(folder: Path, startup: str = SCH, **sources: str) -> Path:
    folder.mkdir(exist_ok=True)
    (folder / "startup.scr").write_text(startup + "!\n")
    (folder / "sch_def_schtbl.tbl").write_bytes(build(schedule_image(SLOTS)))
    (folder / "sch_def_msgtbl.tbl").write_bytes(build(message_image(MESSAGES)))
    for name, source in sources.items():
        (folder / f"{name}.py").write_text(source)
    return folder


@pytest.fixture
def flight(tmp_path: Path) -> Iterator[Flight]:
    flight = Flight(write_mission(tmp_path))
    with flight.mission:
        flight.run_to(1)
        yield flight


def test_messages_go_out_in_their_slots_for_ever(flight: Flight) -> None:
    flight.run_to(120.6)
    seconds = len(flight.times(FIRST))
    assert seconds >= 119
    assert flight.times(FIRST) == [second * 1000.0 for second in range(seconds)]
    odd = [(second * 1000.0 + 250) for second in range(1, seconds, 2)]
    assert flight.times(SECOND) == odd
    assert flight.times(THIRD) == []
    assert flight.events() == []


def test_housekeeping(flight: Flight) -> None:
    flight.run_to(10.6)
    values = flight.housekeeping()
    seconds = len(flight.times(pk.HK_TLM_MID))
    assert values["SlotsProcessedCount"] == seconds * 100 - 1  # the last slot is being done
    assert values["ValidMajorFrameCount"] == seconds
    assert (values["MissedMajorFrameCount"], values["UnexpectedMajorFrameCount"]) == (0, 0)
    assert (values["SyncToMET"], values["MajorFrameSource"]) == (0, 1)
    assert (values["TableVerifySuccessCount"], values["TableVerifyFailureCount"]) == (2, 0)
    assert (values["MinorFramesSinceTone"], values["NextSlotNumber"], values["TablePassCount"]) == (99, 99, seconds - 1)
    assert values["ScheduleActivitySuccessCount"] == 2 * seconds + seconds // 2
    assert values["SkippedSlotsCount"] == values["MultipleSlotsCount"] == values["SameSlotCount"] == 0


def test_entries_are_enabled_and_disabled(flight: Flight) -> None:
    entry = partial(pk.ENABLE.packet, SlotNumber=25)
    flight.run_to(3.1)
    flight.send(DEBUG_ON, entry(EntryNumber=1), pk.DISABLE.packet(SlotNumber=0, EntryNumber=0))
    flight.run_to(6.6)
    assert flight.times(THIRD) == [2250.0, 3250.0, 4250.0]  # commands wait for the end of the table
    assert flight.times(FIRST) == [0.0, 1000.0]
    assert flight.seen[-1].msg_id in (pk.HK_TLM_MID, THIRD)
    assert [line for line in flight.events() if line[0] == "4"] == [
        "42: ENABLE command: slot = 25, entry = 1",
        "43: DISABLE command: slot = 0, entry = 0",
    ]
    assert flight.housekeeping()["CmdCounter"] == 2


def test_a_message_is_sent_as_it_stands_in_the_table(flight: Flight) -> None:
    flight.send(pk.ENABLE.packet(SlotNumber=25, EntryNumber=1))
    flight.run_to(4.6)
    sent = [seen.packet for seen in flight.seen if seen.msg_id == THIRD]
    assert [(packet[6] & 0x7F, packet[8:]) for packet in sent] == [(5, b"\1\2")] * len(sent)
    assert len(sent) >= 2


@pytest.mark.parametrize(
    ("groups", "found"), [(0x02000000, 2), (0x00000002, 1), (0x00000003, 2), (0x09000001, 1), (0x02FF0000, 2)]
)
def test_groups(flight: Flight, groups: int, found: int) -> None:
    flight.send(DEBUG_ON)
    flight.run_to(2.1)
    flight.send(pk.DISABLE_GROUP.packet(GroupData=groups), pk.ENABLE_GROUP.packet(GroupData=groups))
    flight.run_to(4.6)
    assert f"45: DISABLE GROUP command: match count = {found}" in flight.events()
    assert f"44: ENABLE GROUP command: match count = {found}" in flight.events()


def test_a_disabled_group_is_silent(flight: Flight) -> None:
    flight.send(pk.DISABLE_GROUP.packet(GroupData=0x02000000))
    flight.run_to(6)
    assert flight.times(SECOND) == flight.times(THIRD) == []
    assert len(flight.times(FIRST)) >= 4


def test_diagnostics(flight: Flight) -> None:
    flight.send(pk.SEND_DIAG_TLM.packet())
    flight.run_to(3)
    (packet,) = [seen.packet for seen in flight.seen if seen.msg_id == pk.DIAG_TLM_MID]
    values = pk.DIAG_TLM.read(packet)
    states = "".join(f"{word:016b}" for word in values["EntryStates"])
    used = {
        number: states[2 * number : 2 * number + 2]
        for number in range(500)
        if states[2 * number : 2 * number + 2] != "00"
    }
    assert used == {0: "01", 125: "01", 126: "10", 495: "01"}
    assert {at: msg_id for at, msg_id in enumerate(values["MsgIDs"]) if msg_id} == {
        0: FIRST,
        125: SECOND,
        126: THIRD,
        495: pk.SEND_HK_MID,
    }


def test_bad_commands(flight: Flight) -> None:
    flight.run_to(2.6)
    flight.send(
        pk.NOOP.packet(),
        pk.ENABLE.packet(SlotNumber=100),
        pk.DISABLE.packet(EntryNumber=5),
        pk.ENABLE.packet(SlotNumber=1),
    )
    flight.run_to(3.6)
    flight.send(
        pk.DISABLE.packet(SlotNumber=0, EntryNumber=1),
        pk.ENABLE_GROUP.packet(),
        pk.DISABLE_GROUP.packet(),
        pk.ENABLE_GROUP.packet(GroupData=0x07000010),
    )
    flight.run_to(4.6)
    flight.send(pk.DISABLE_GROUP.packet(GroupData=0x00000010))
    flight.send(command(pk.CMD_MID, 9), command(pk.CMD_MID, 0, b"x"), command(pk.SEND_HK_MID, 0, b"x"))
    flight.run_to(6.6)
    assert flight.events() == [
        "40: NO-op command. Version 2.2.1.0",
        "50: ENABLE cmd: invalid argument, slot=100 (<100), entry=0 (<5)",
        "52: DISABLE cmd: invalid argument, slot=0 (<100), entry=5 (<5)",
        "51: ENABLE command: invalid state = 0, slot = 1, entry = 0",
        "53: DISABLE command: invalid state = 0, slot = 0, entry = 1",
        "54: ENABLE GROUP command: invalid argument, no groups selected",
        "56: DISABLE GROUP command: invalid argument, no groups selected",
        "55: ENABLE GROUP command: Neither Group 7 nor Multi-Group 0x000010 found",
        "57: DISABLE GROUP command: Neither Group 0 nor Multi-Group 0x000010 found",
        "58: Invalid command code: ID = 0x1895, CC = 9",
        "60: Cmd Msg with Bad length Rcvd: ID = 0x1895, CC = 0, Exp Len = 8, Len = 9",
        "60: Cmd Msg with Bad length Rcvd: ID = 0x1896, CC = 0, Exp Len = 8, Len = 9",
    ]
    values = flight.housekeeping()
    assert (values["CmdCounter"], values["ErrCounter"]) == (1, 10)


def test_counters_are_reset_but_not_the_passes(flight: Flight) -> None:
    flight.run_to(4.6)
    flight.send(DEBUG_ON, pk.RESET.packet())
    flight.run_to(5.6)
    values = flight.housekeeping()
    assert "41: RESET command" in flight.events()
    assert values["TablePassCount"] == 2
    assert (values["SlotsProcessedCount"], values["ValidMajorFrameCount"], values["TableVerifySuccessCount"]) == (
        0,
        0,
        0,
    )


def hogged(folder: Path, busy_ms: int) -> Flight:
    """A flight with an app that is more urgent than SCH and keeps the processor from 330 ms of a second on."""
    hog = HOG.format(at_ms=4_330, busy_ms=busy_ms)
    startup = SCH + "CFE_APP, hog, Main, HOG, 30, 8192, 0x0, 0;\n"
    return Flight(write_mission(folder, startup, hog=hog))


def test_slots_that_another_app_delayed_are_made_up_for(tmp_path: Path) -> None:
    flight = hogged(tmp_path, 75)
    with flight.mission:
        flight.run_to(8)
    values = flight.housekeeping()
    assert values["MultipleSlotsCount"] >= 2
    assert (values["SkippedSlotsCount"], values["SameSlotCount"]) == (0, 0)
    assert len(flight.times(pk.HK_TLM_MID)) * 100 - 1 == values["SlotsProcessedCount"]
    assert len([line for line in flight.events() if line.startswith("18:")]) == 1  # filtered until housekeeping
    assert flight.events()[0].endswith("count = 5")
    late = [time for time in flight.times(FIRST) if time % 1000]
    assert late == []


def test_too_long_a_delay_skips_slots(tmp_path: Path) -> None:
    flight = hogged(tmp_path, 600)
    with flight.mission:
        flight.run_to(8)
    values = flight.housekeeping()
    assert values["SkippedSlotsCount"] == 1
    (event,) = [line for line in flight.events() if line.startswith("17:")]
    slot, count = (int(part.partition(" = ")[2]) for part in event.partition(": Slots skipped: ")[2].split(", "))
    assert slot < 100
    assert count > 50
    assert values["SlotsProcessedCount"] == len(flight.times(pk.HK_TLM_MID)) * 100 - 1 - count


def test_the_library_holds_the_schedule(tmp_path: Path) -> None:
    startup = "CFE_LIB, sch_lib, SCH_LibInit, SCH_LIB, 0, 0, 0, 0;\n" + SCH
    startup += "CFE_APP, holder, Main, HOLDER, 60, 8192, 0x0, 0;\n"
    flight = Flight(write_mission(tmp_path, startup, holder=HOLDER))
    with flight.mission:
        flight.run_to(10)
    sent = flight.times(FIRST)
    gaps = [after - before for before, after in pairwise(sent)]
    assert max(gaps) in (2000.0, 3000.0)
    assert gaps.count(1000.0) == len(gaps) - 1


def test_a_bad_schedule_from_the_ground_is_refused(flight: Flight) -> None:
    bad = schedule_image({7: [activity(1, 1, 1)]})
    flight.mission.files.write_file("/ram/bad.tbl", build(bad))
    flight.mission.files.write_file("/ram/good.tbl", build(schedule_image({50: [activity(1)], 99: [activity(4)]})))
    validate = tbl.VALIDATE.packet(TableName="SCH.SCHED_DEF")
    flight.run_to(2.6)
    flight.send(tbl.LOAD.packet(LoadFilename="/ram/bad.tbl"), validate)
    flight.run_to(4.6)
    text = "idx[35] ena[1] typ[1] fre[1] rem[1] msg[1] grp[0x00000000]"
    assert flight.events() == [f"30: Schedule tbl verify error - {text}"]
    assert flight.housekeeping()["TableVerifyFailureCount"] == 1
    flight.send(tbl.ABORT_LOAD.packet(TableName="SCH.SCHED_DEF"))
    flight.send(tbl.LOAD.packet(LoadFilename="/ram/good.tbl"), validate)
    flight.run_to(6.6)
    flight.send(tbl.ACTIVATE.packet(TableName="SCH.SCHED_DEF"))
    flight.run_to(9.6)
    assert flight.times(FIRST)[-2:] == [500.0 + 1000 * (len(flight.times(FIRST)) - number) for number in (2, 1)]


def test_corrupt_entries_are_disabled(flight: Flight) -> None:
    flight.run_to(2.6)
    active = flight.mission.cfe.tbl.registry.by_name("SCH.SCHED_DEF").active
    assert active is not None
    active.data[2:4] = b"\0\0"  # no frequency in the entry of slot 0
    flight.run_to(5.6)
    assert flight.events() == [
        "19: Corrupt data error (1): slot = 0, entry = 0",
        "19: Corrupt data error (2): msg = 1, freq = 0, type = 1, rem = 0",
    ]
    assert flight.housekeeping()["BadTableDataCount"] == 1


def test_a_message_that_the_bus_refuses(tmp_path: Path) -> None:
    folder = write_mission(tmp_path)
    (folder / "sch_def_msgtbl.tbl").write_bytes(
        build(message_image({**MESSAGES, 1: bytes.fromhex("0000c0000001") + bytes(2)}))
    )
    flight = Flight(folder)
    with flight.mission:
        flight.run_to(3.995)
    assert flight.events() == ["20: Activity error: slot = 0, entry = 0, err = 0xCA000003"] * 2
    assert flight.housekeeping()["ScheduleActivityFailureCount"] == 2


def test_a_coarse_timer_keeps_all_slots(tmp_path: Path) -> None:
    board = tmp_path / "board.yaml"
    board.write_text("name: coarse\ntick_ns: 10_000_000\n")
    flight = Flight(write_mission(tmp_path / "mission"), board=str(board))
    with flight.mission:
        flight.run_to(10.6)
    assert flight.events()[0] == "13: OS Timer Accuracy (10000 > reqd 101 usec) requires Minor Frame MET sync"
    values = flight.housekeeping()
    assert (values["SyncToMET"], values["SkippedSlotsCount"]) == (1, 0)
    assert values["SlotsProcessedCount"] >= 100 * (len(flight.times(pk.HK_TLM_MID)) - 1)
    first = flight.times(FIRST)
    assert all(abs(time - 1000.0 * number) <= 10 for number, time in enumerate(first))


@pytest.mark.parametrize(
    ("file", "image", "event"),
    [
        (
            "sch_def_schtbl.tbl",
            schedule_image({0: [activity(1, 0)]}),
            "9: Error (RC=0xFFFFFFFE) Loading SDT with /cf/sch_def_schtbl.tbl",
        ),
        (
            "sch_def_msgtbl.tbl",
            message_image({3: init(0x1808, 9)}),
            "10: Error (RC=0xFFFFFFFE) Loading MDT with /cf/sch_def_msgtbl.tbl",
        ),
    ],
)
def test_without_good_tables_it_ends(tmp_path: Path, file: str, image: TableImage, event: str) -> None:
    folder = write_mission(tmp_path)
    (folder / file).write_bytes(build(image))
    flight = Flight(folder)
    with flight.mission:
        flight.run_to(3)
        states = {app.name for app in flight.mission.cfe.es.apps}
    assert flight.events()[-2:] == [event, "2: SCH App: terminating, err = 0xFFFFFFFE"]
    assert any("SCH App terminating, err = 0xFFFFFFFE" in line for line in flight.mission.console.lines)
    assert "SCH" not in states


def test_both_kinds_of_task_contexts_give_one_trace(tmp_path: Path) -> None:
    write_mission(tmp_path)
    digests = set()
    for tasks in ("thread", "greenlet"):
        with Mission(str(tmp_path), tasks=tasks, console=Console(quiet=True)) as mission:
            mission.run(5)
            digests.add(mission.trace.digest())
    assert len(digests) == 1


@pytest.mark.parametrize(
    ("function", "event"),
    [
        ("sb.create_pipe", (3, 3, "Error Creating SB Pipe, RC=0xCA000003")),
        ("sb.subscribe", (4, 3, "Error Subscribing to HK Request(MID=0x1896), RC=0xCA000003")),
        ("os.timer_create", (12, 3, "Error creating Timer (RC=0xFFFFFFF0)")),
        ("os.bin_sem_create", (15, 3, "Error creating Main Loop Timing Semaphore (RC=0xFFFFFFF0)")),
        ("time.register_synch_callback", (14, 3, "Error initializing Timers (RC=0xCA000003)")),
    ],
)
def test_a_start_that_fails(function: str, event: tuple[int, int, str]) -> None:
    bench = AppBench("SCH")
    service, _, name = function.partition(".")
    status = OS_ERR_INVALID_ID if service == "os" else CFE_SB_BAD_ARGUMENT
    error = (OsalError if service == "os" else CfeError)(status, "the test says so")

    def fail(*arguments: object) -> None:
        raise error

    bench.cfe.os = SimpleNamespace(
        timer_create=lambda name, callback: 1,
        timer_get_info=lambda timer: SimpleNamespace(accuracy=1),
        bin_sem_create=lambda name, value: 1,
        symbol_lookup=bench.cfe.os.symbol_lookup,
    )
    bench.cfe.time = SimpleNamespace(register_synch_callback=fail, unregister_synch_callback=fail)
    bench.cfe.es.wait_for_startup_sync = lambda timeout_ms: None
    bench.cfe.evs.register = lambda filters: None
    setattr(getattr(bench.cfe, service), name, fail)
    if service == "os":
        bench.cfe.time.unregister_synch_callback = lambda callback: None
    bench.run(SCH_AppMain)
    assert event in bench.events
    assert bench.events[-1] == (2, 4, f"SCH App: terminating, err = 0x{status & 0xFFFFFFFF:08X}")
    assert bench.exit_status == APP_ERROR
