"""NASA's requirements for the performance log, which they call the logic analyzer (cES1021-1023, 1029-1031)."""

from __future__ import annotations

from collections.abc import Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from cfepy.es import packets as pk
from cfepy.fs import read_header
from cfepy.mission import Mission
from cfepy.writing.console import Console
from tests.mission.flights import write_mission
from tests.requirements.covers import covers
from tests.requirements.ground import Ground

STARTUP = "CFE_APP, worker, worker_main, WORKER, 50, 16384, 0x0, 0;\n!"
WORKER = """
    def worker_main(cfe):
        while cfe.es.run_loop():
            cfe.es.perf_log_entry(40)
            cfe.os.task_delay(10)
            cfe.es.perf_log_exit(40)
            cfe.es.perf_log_add(200, 0)
            cfe.os.task_delay(90)
"""
ENTRY, EXIT = 40, 40 | 1 << 31
START, CENTER, END = 0, 1, 2


@pytest.fixture
def ground(tmp_path: Path) -> Iterator[Ground]:
    board = tmp_path / "small.yaml"
    board.write_text("name: small\nlimits:\n  es_perf_data_buffer_size: 100\n", encoding="utf-8")
    folder = write_mission(tmp_path, STARTUP, worker=WORKER)
    with Mission(folder, board=str(board), console=Console(quiet=True)) as mission:
        mission.run_for(1.05)
        ground = Ground(mission)
        ground.show_debug_events("CFE_ES")
        yield ground


def housekeeping(ground: Ground) -> dict[str, Any]:
    return ground.answer(pk.SEND_HK, pk.HK_TLM)


def only_the_worker(ground: Ground) -> None:
    for number in range(4):
        ground.command(pk.SET_PERF_FILTER_MASK, 0.001, FilterMaskNum=number, FilterMask=0x100 if number == 1 else 0)


def entries(data: bytes) -> list[dict[str, int]]:
    at = 64 + pk.PERF_METADATA.size
    return [pk.PERF_ENTRY.unpack(data, each) for each in range(at, len(data), pk.PERF_ENTRY.size)]


@covers("cES1021", "cES1022", "cES1022.1", "cES1023", "cES1029")
def test_cES1021_marked_places_are_recorded_with_the_time_and_written_to_a_file(ground: Ground) -> None:
    only_the_worker(ground)
    assert ground.command(pk.START_PERF_DATA, 1, TriggerMode=START) == [
        "CFE_ES 57: Start collecting performance data cmd received, trigger mode = 0"
    ]
    begun, written = ground.command(pk.STOP_PERF_DATA, 1, DataFileName="/ram/perf.dat")
    assert begun == "CFE_ES 60: Perf Stop Cmd Rcvd, will write 20 entries.20mS dly every 50 entries"
    assert written == f"CFE_ES 68: /ram/perf.dat written:Size={64 + 76 + 20 * 12},EntryCount=20"
    data = ground.file("/ram/perf.dat")
    assert (read_header(data).description, read_header(data).subtype) == ("ES Performance data file", 4)
    meta = pk.PERF_METADATA.unpack(data, 64)
    assert (meta["Version"], meta["Endian"], meta["State"], meta["Mode"], meta["DataCount"]) == (1, 0, 0, START, 20)
    assert (meta["TimerTicksPerSecond"], meta["FilterTriggerMaskSize"]) == (10**9, 4)
    assert meta["FilterMask"] == [0, 0x100, 0, 0]
    marks = [entry["Data"] for entry in entries(data)]
    assert marks in ([ENTRY, EXIT] * 10, [EXIT, ENTRY] * 10)
    times = [entry["TimerUpper32"] * 10**9 + entry["TimerLower32"] for entry in entries(data)]
    assert {later - sooner for sooner, later in pairwise(times)} == {10_000_000, 90_000_000}


@covers("cES1021", "cES1022")
def test_cES1021_an_invalid_marker_is_reported_once(ground: Ground) -> None:
    ground.command(pk.START_PERF_DATA, 1, TriggerMode=START)
    assert ground.lines("CFE_ES_PerfLogAdd") == ["CFE_ES_PerfLogAdd: Invalid performance marker 200,max is 127"]


def test_cES1022_2_a_full_log_loses_its_oldest_entries(ground: Ground) -> None:
    only_the_worker(ground)
    ground.command(pk.START_PERF_DATA, 6.03, TriggerMode=START)
    values = housekeeping(ground)
    assert values["PerfDataCount"] == 100
    assert values["PerfDataStart"] == values["PerfDataEnd"] > 0
    ground.command(pk.STOP_PERF_DATA, 1)
    found = entries(ground.file("/ram/cfe_es_perf.dat"))
    times = [entry["TimerUpper32"] * 10**9 + entry["TimerLower32"] for entry in found]
    assert len(times) == 100
    assert times == sorted(times)
    assert times[0] > 2 * 10**9


def test_cES1023_1_performance_file_has_a_default_name(ground: Ground) -> None:
    ground.command(pk.START_PERF_DATA, TriggerMode=START)
    ground.command(pk.STOP_PERF_DATA, 1)
    assert len(entries(ground.file("/ram/cfe_es_perf.dat"))) > 0


def test_cES1023_a_dump_that_fails_is_reported(ground: Ground) -> None:
    ground.command(pk.START_PERF_DATA, TriggerMode=START)
    assert ground.command(pk.STOP_PERF_DATA, 1, DataFileName="/nowhere/x")[1:] == [
        "CFE_ES 67: Error creating file /nowhere/x, RC = -108"
    ]
    assert ground.command(pk.STOP_PERF_DATA, 1, DataFileName="/ram/") == [
        "CFE_ES 67: Error parsing filename, RC = -973078526"
    ]
    ground.mission.files.write_file("/ram/big", bytes(2097000))
    (_, event) = ground.command(pk.STOP_PERF_DATA, 1, DataFileName="/ram/x")
    assert event.startswith("CFE_ES 74: File write,byte cnt err,file /ram/x,request=")


@covers("cES1023", "cES1029")
def test_cES1023_only_one_performance_command_runs_at_a_time(ground: Ground) -> None:
    ground.command(pk.START_PERF_DATA, 5, TriggerMode=START)
    ground.command(pk.STOP_PERF_DATA, 0.03)
    assert ground.mission.processor.es_task.perf_dump.remaining == 52  # 50 steps in 20 ms, two of them for headers
    assert ground.command(pk.START_PERF_DATA, 0.001, TriggerMode=START) == [
        "CFE_ES 58: Cannot start collecting performance data,perf data write in progress"
    ]
    assert ground.command(pk.STOP_PERF_DATA, 0.001) == [
        "CFE_ES 62: Stop performance data cmd ignored,perf data write in progress"
    ]
    ground.mission.run_for(1)
    assert ground.command(pk.START_PERF_DATA, TriggerMode=3) == [
        "CFE_ES 59: Cannot start collecting performance data, trigger mode (3) out of range (0 to 2)"
    ]


def test_cES1030_filter_mask_selects_the_recorded_markers(ground: Ground) -> None:
    assert ground.command(pk.SET_PERF_FILTER_MASK, FilterMaskNum=1, FilterMask=0) == [
        "CFE_ES 63: Set Performance Filter Mask Cmd rcvd, num 1, val 0x00000000"
    ]
    assert ground.command(pk.SET_PERF_FILTER_MASK, FilterMaskNum=4, FilterMask=0) == [
        "CFE_ES 64: Performance Filter Mask Cmd Error,Index(4)out of range(4)"
    ]
    assert housekeeping(ground)["PerfFilterMask"] == [0xFFFFFFFF, 0, 0xFFFFFFFF, 0xFFFFFFFF]
    ground.command(pk.START_PERF_DATA, TriggerMode=START)
    ground.command(pk.STOP_PERF_DATA, 1)
    marks = {entry["Data"] & 0x7FFFFFFF for entry in entries(ground.file("/ram/cfe_es_perf.dat"))}
    assert 40 not in marks
    assert 1 in marks  # CFE_ES itself


@pytest.mark.parametrize(("mode", "after"), [(START, 100), (CENTER, 50), (END, 1)])
def test_cES1031_trigger_mask_ends_the_recording(ground: Ground, mode: int, after: int) -> None:
    only_the_worker(ground)
    assert ground.command(pk.SET_PERF_TRIGGER_MASK, 0.001, TriggerMaskNum=1, TriggerMask=0x100) == [
        "CFE_ES 65: Set Performance Trigger Mask Cmd rcvd,num 1, val 0x00000100"
    ]
    ground.command(pk.START_PERF_DATA, 8, TriggerMode=mode)
    values = housekeeping(ground)
    assert (values["PerfState"], values["PerfTriggerCount"], values["PerfDataCount"]) == (0, after, after)
    assert ground.command(pk.SET_PERF_TRIGGER_MASK, TriggerMaskNum=4, TriggerMask=0) == [
        "CFE_ES 66: Performance Trigger Mask Cmd Error,Index(4)out of range(4)"
    ]
