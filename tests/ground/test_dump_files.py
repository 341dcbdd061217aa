"""Reading files that a real cFE wrote, truncated files, and files of other programs."""

from __future__ import annotations

import struct
from pathlib import Path

import pytest

from cfepy.es.packets import PERF_ENTRY, PERF_METADATA
from cfepy.fs import FileHeader
from cfepy.fs.header import SUBTYPE_ES_PERFDATA, SUBTYPE_TBL_IMG
from cfepy.ground.cfe_files.dump_files import EXIT_BIT, DumpFile, read_dump, timings, value_at
from cfepy.status import UsageError

DATA = Path(__file__).parents[1] / "data"


def golden(name: str) -> DumpFile:
    return read_dump((DATA / name).read_bytes(), name)


def shown(dump: DumpFile, number: int) -> list[str]:
    """Return a record as text."""
    record = dump.records[number]
    return [column.text(value_at(record, column.path)) for column in dump.columns]


def test_every_golden_file_decodes_whole() -> None:
    paths = [path for path in sorted(DATA.glob("cfe_*")) if path.suffix != ".tbl"]
    files = [path.name for path in paths]
    kinds = {name: golden(name).kind for name in files}
    assert not any(golden(name).problem for name in files)
    assert len(set(kinds.values())) == len(files) == 11


def test_header() -> None:
    header = golden("cfe_evs.log").header
    assert (header.spacecraft_id, header.processor_id, header.application_id) == (66, 1, 0x00110001)
    assert header.description == "cFE EVS Log File"


def test_event_log() -> None:
    dump = golden("cfe_evs.log")
    text = "cFE EVS Initialized: CFE_EVS v7.0.0+dev0 (Draco) v7.0.0 Official Release, EDS disabled"
    assert len(dump.records) == 20
    assert shown(dump, 0) == ["1980-012-14:03:20.05056", "CFE_EVS", "INFO", "1", text]
    assert shown(dump, 2)[1:] == ["CFE_SB", "INFO", "14", "No subscribers for MsgId 0x808,sender CFE_SB"]


def test_event_settings() -> None:
    dump = golden("cfe_evs_app.dat")
    filters = "14: 0xFFFC (22), 7: 0xFFFC (0), 17: 0xFFF0 (0), 25: 0xFFF0 (0)"
    assert shown(dump, 1) == ["CFE_SB", "yes", "0x000E", "6", "0", filters]
    assert shown(dump, 0)[-1] == ""


def test_applications() -> None:
    dump = golden("cfe_es_app_info.log")
    assert len(dump.records) == 12
    assert shown(dump, 5)[1:8] == [
        "external",
        "SAMPLE_APP",
        "SAMPLE_APP_Main",
        "/cf/sample_app.so",
        "16384",
        "50",
        "restart app",
    ]
    assert [row["Name"] for row in dump.records if row["Type"] == 3] == ["ASSERT_LIB", "SAMPLE_LIB"]


def test_tasks() -> None:
    dump = golden("cfe_es_taskinfo.log")
    assert shown(dump, 3)[:6] == ["0x00010004", "ES_BG_TASK", "CFE_ES", "0x00110003", "200", "4096"]


def test_system_log() -> None:
    lines = golden("cfe_es_syslog.log").lines
    assert lines[0].endswith("CFE_ES_SetupResetVariables: POWER ON RESET due to Power Cycle (Power Cycle).")
    assert lines[-1] == "1980-012-14:03:20.60260 CFE_ES_Main: CFE_ES_Main entering OPERATIONAL state"


def test_exception_and_reset_log() -> None:
    dump = golden("cfe_erlog.log")
    text = "POWER ON RESET due to Power Cycle (Power Cycle)"
    assert shown(dump, 0) == ["1980-001-00:47:57.97936", "core", "power-on", "1", "0", "0", "0x00000000", text]


def test_critical_data_store() -> None:
    assert shown(golden("cfe_cds_reg.log"), 0) == ["0x00150001", "4096", "yes", "CFE_TBL.CritReg"]


def test_tables() -> None:
    dump = golden("cfe_tbl_reg.log")
    assert shown(dump, 0)[:5] == ["SAMPLE_APP.ExampleTable", "4", "0x9C00", "1", "yes"]
    assert dump.records[0]["LastFileLoaded"] == "/cf/sample_app_tbl.tbl"


def test_bus_files() -> None:
    assert shown(golden("cfe_sb_pipe.dat"), 0)[1:6] == ["EVS_CMD_PIPE", "CFE_EVS", "32", "0", "1"]
    assert shown(golden("cfe_sb_route.dat"), 0) == ["0x1801", "EVS_CMD_PIPE", "CFE_EVS", "yes", "0"]
    assert shown(golden("cfe_sb_msgmap.dat"), 1) == ["0x1809", "1"]


def test_truncated_file_gives_its_complete_records_and_a_problem() -> None:
    dump = read_dump((DATA / "cfe_sb_pipe.dat").read_bytes()[:-1], "x")
    assert len(dump.records) == 10
    assert dump.problem == "is truncated: record 10 has 59 of 60 bytes"


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (b"cFE1", "is not a cFE file: a cFE file must have a header of 64 bytes"),
        (b"\x7fELF" + bytes(60), 'begins with 7f 45 4c 46, not with "cFE1"'),
        (FileHeader("x", 99).pack(), "unknown subtype 99"),
        (FileHeader("x", SUBTYPE_TBL_IMG).pack(), "cfepy tbl show some.log"),
    ],
)
def test_foreign_files(data: bytes, words: str) -> None:
    with pytest.raises(UsageError, match=words):
        read_dump(data, "some.log")


def perf_file(*entries: tuple[int, int, int], count: int | None = None, endian: int = 0) -> bytes:
    """Return a file of entries (data, upper, lower).

    The timer counts 1000 a second, and its lower half goes up to 100.
    """
    about = {"Endian": endian, "TimerTicksPerSecond": 1000, "TimerLow32Rollover": 100}
    head = PERF_METADATA.pack(about, DataCount=len(entries) if count is None else count)
    rows = (PERF_ENTRY.pack(Data=data, TimerUpper32=upper, TimerLower32=lower) for data, upper, lower in entries)
    return FileHeader("ES Performance data file", SUBTYPE_ES_PERFDATA).pack() + head + b"".join(rows)


def test_performance_data() -> None:
    data = perf_file(
        (5, 0, 10), (7, 0, 90), (7 | EXIT_BIT, 1, 10), (5 | EXIT_BIT, 1, 20), (7 | EXIT_BIT, 1, 30), (5, 2, 0)
    )
    dump = read_dump(data, "perf")
    assert [(row["Id"], row["IsExit"], row["TimeUs"]) for row in dump.records[:3]] == [
        (5, False, 10_000),
        (7, False, 90_000),
        (7, True, 110_000),
    ]
    found = timings(dump.records)
    assert {number: timing.taken_us for number, timing in found.items()} == {5: [110_000], 7: [20_000]}
    assert (found[5].open, found[7].unpaired, dump.problem) == ([200_000], 1, "")


def test_entry_inside_another_of_the_same_id_is_timed() -> None:
    dump = read_dump(perf_file((5, 0, 0), (5, 0, 10), (5 | EXIT_BIT, 0, 15), (5 | EXIT_BIT, 0, 40)), "perf")
    assert timings(dump.records)[5].taken_us == [5_000, 40_000]


@pytest.mark.parametrize(
    ("data", "words"),
    [
        (perf_file((5, 0, 0), count=2), "it has 1 of 2 entries"),
        (perf_file((5, 0, 0))[:-1], "it has 0 of 1 entries"),
        (perf_file()[:100], "the metadata have 36 of 76 bytes"),
        (perf_file(endian=1), "big-endian"),
    ],
)
def test_invalid_performance_data_is_reported(data: bytes, words: str) -> None:
    assert words in read_dump(data, "perf").problem


def test_timer_without_rollover_counts_whole_words() -> None:
    head = PERF_METADATA.pack(TimerTicksPerSecond=1 << 31, DataCount=1)
    body = head + struct.pack("<III", 1, 2, 1 << 31)
    dump = read_dump(FileHeader("p", SUBTYPE_ES_PERFDATA).pack() + body, "perf")
    assert dump.records[0]["TimeUs"] == 5_000_000
