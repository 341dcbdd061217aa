"""SCH when the processor, its library or the board delay its slots, and when it cannot start."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from types import SimpleNamespace

import pytest

from apps.sch import SCH_AppMain
from apps.sch import packets as pk
from apps.sch.definition import activity, message_image, schedule_image
from cfepy.es import APP_ERROR
from cfepy.msg import init
from cfepy.status import CFE_SB_BAD_ARGUMENT, OS_ERR_INVALID_ID, CfeError, OsalError
from cfepy.tbl import TableImage, build
from tests.apps.conftest import AppBench
from tests.apps.sch_flight import FIRST, SCH, Flight, write_mission

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


def hogged(folder: Path, busy_ms: int) -> Flight:
    """Return a flight with an app that is more urgent than SCH and keeps the processor from 330 ms of a second on."""
    hog = HOG.format(at_ms=4_330, busy_ms=busy_ms)
    startup = SCH + "CFE_APP, hog, Main, HOG, 30, 8192, 0x0, 0;\n"
    return Flight(write_mission(folder, startup, hog=hog))


def test_slots_delayed_by_another_app_are_processed_later(tmp_path: Path) -> None:
    flight = hogged(tmp_path, 75)
    with flight.mission:
        flight.run_to(8)
    values = flight.housekeeping()
    assert values["MultipleSlotsCount"] >= 2
    assert (values["SkippedSlotsCount"], values["SameSlotCount"]) == (0, 0)
    assert len(flight.times(pk.HK_TLM_MID)) * 100 - 1 == values["SlotsProcessedCount"]
    assert len([line for line in flight.events() if line.startswith("18:")]) == 1  # filtered until housekeeping
    assert flight.events()[1].endswith("count = 5")
    late = [time for time in flight.times(FIRST) if time % 1000]
    assert late == []


def test_too_long_delay_skips_slots(tmp_path: Path) -> None:
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


def test_schedule_waits_for_the_lock_of_its_library(tmp_path: Path) -> None:
    startup = "CFE_LIB, sch_lib, SCH_LibInit, SCH_LIB, 0, 0, 0, 0;\n" + SCH
    startup += "CFE_APP, holder, Main, HOLDER, 60, 8192, 0x0, 0;\n"
    flight = Flight(write_mission(tmp_path, startup, holder=HOLDER))
    with flight.mission:
        flight.run_to(10)
    sent = flight.times(FIRST)
    gaps = [after - before for before, after in pairwise(sent)]
    assert max(gaps) in (2000.0, 3000.0)
    assert gaps.count(1000.0) == len(gaps) - 1


def test_a_coarse_timer_keeps_all_slots(tmp_path: Path) -> None:
    board = tmp_path / "board.yaml"
    board.write_text("name: coarse\ntick_ns: 10_000_000\n", encoding="utf-8")
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
def test_app_ends_when_its_tables_are_invalid(tmp_path: Path, file: str, image: TableImage, event: str) -> None:
    folder = write_mission(tmp_path)
    (folder / file).write_bytes(build(image))
    flight = Flight(folder)
    with flight.mission:
        flight.run_to(3)
        states = {app.name for app in flight.mission.cfe.es.apps}
    assert flight.events()[-2:] == [event, "2: SCH App: terminating, err = 0xFFFFFFFE"]
    assert any("SCH App terminating, err = 0xFFFFFFFE" in line for line in flight.mission.console.lines)
    assert "SCH" not in states


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
