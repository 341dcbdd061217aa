"""NASA's requirements for the system log and the exception and reset log (cES1014-1019, 1028)."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest

from cfepy.es import packets as pk
from cfepy.fs import read_header
from cfepy.mission import Mission
from cfepy.status import CFE_ES_ERR_SYS_LOG_FULL, CFE_ES_ERR_SYS_LOG_TRUNCATED, CFE_SUCCESS
from cfepy.writing.console import Console
from tests.mission.flights import write_mission
from tests.requirements.covers import covers
from tests.requirements.ground import Ground

STARTUP = "CFE_APP, fails, fails_main, FAILS, 50, 16384, 0x0, 0;\n!"
FAILS = """
    def fails_main(cfe):
        cfe.es.run_loop()
        cfe.os.task_delay(8000)
        if not cfe.os.files.exists("/ram/failed"):
            cfe.os.files.write_file("/ram/failed", b"")
            raise ValueError("a wheel fell off")
        while cfe.es.run_loop():
            cfe.os.task_delay(100)
"""
LINE = re.compile(rb"\d{4}-\d{3}-\d\d:\d\d:\d\d\.\d{5} \S.*\n")


@pytest.fixture
def ground(tmp_path: Path) -> Iterator[Ground]:
    with Mission(write_mission(tmp_path, STARTUP, fails=FAILS), console=Console(quiet=True)) as mission:
        mission.run_for(1)
        ground = Ground(mission)
        ground.show_debug_events("CFE_ES")
        yield ground


def log_of(ground: Ground) -> bytes:
    return ground.mission.cfe.es.syslog.read()


def housekeeping(ground: Ground) -> dict[str, int]:
    return ground.answer(pk.SEND_HK, pk.HK_TLM)


# -- the system log ----------------------------------------------------------------------------------------------------


@covers("cES1014", "cES1014.1")
def test_cES1014_significant_events_are_logged_with_their_time(ground: Ground) -> None:
    ground.command(pk.STOP_APP, Application="FAILS")
    lines = log_of(ground).splitlines(keepends=True)
    assert log_of(ground).isascii()
    assert all(LINE.fullmatch(line) for line in lines)
    assert lines[-1].endswith(b" CFE_ES_DeleteApp: Delete Application FAILS Initiated\n")
    assert lines[-1].startswith(ground.mission.cfe.time.print_((1001001, 0)).encode()[:17])


def test_cES1014_2_the_use_of_the_log_is_counted(ground: Ground) -> None:
    before = housekeeping(ground)
    ground.mission.cfe.es.write_to_sys_log("twelve bytes")
    after = housekeeping(ground)
    assert after["SysLogEntries"] == before["SysLogEntries"] + 1
    assert after["SysLogBytesUsed"] == before["SysLogBytesUsed"] + 24 + 12 + 1
    assert after["SysLogBytesUsed"] == len(log_of(ground))


def test_cES1014_2_1_a_full_log_continues_at_its_top(ground: Ground) -> None:
    es = ground.mission.cfe.es
    for number in range(100):
        assert es.write_to_sys_log(f"line {number:02} {'x' * 40}") == CFE_SUCCESS
    assert housekeeping(ground)["SysLogMode"] == 0
    assert housekeeping(ground)["SysLogBytesUsed"] <= 3072
    lines = log_of(ground).splitlines()
    numbers = [int(line.split()[2]) for line in lines]
    assert numbers == list(range(100 - len(lines), 100))
    assert es.syslog.data.memory.index(b"line 99") < es.syslog.data.memory.index(b"line 60")


def test_cES1014_2_2_a_full_log_in_discard_mode_does_not_change(ground: Ground) -> None:
    es = ground.mission.cfe.es
    assert ground.command(pk.OVER_WRITE_SYS_LOG, Mode=1) == [
        "CFE_ES 70: Set OverWriteSysLog Command Received with Mode setting = 1"
    ]
    assert housekeeping(ground)["SysLogMode"] == 1
    statuses = [es.write_to_sys_log(f"line {number:02} {'x' * 40}") for number in range(100)]
    full = log_of(ground)
    assert statuses[0] == CFE_SUCCESS
    assert statuses[-1] == CFE_ES_ERR_SYS_LOG_FULL
    assert {*statuses} <= {CFE_SUCCESS, CFE_ES_ERR_SYS_LOG_TRUNCATED, CFE_ES_ERR_SYS_LOG_FULL}
    assert full.startswith(b"1980-001-00:00:00.00000 CFE_ES_SetupResetVariables")
    es.write_to_sys_log("one more")
    assert log_of(ground) == full


def test_cES1028_the_mode_of_the_log_is_set_by_command(ground: Ground) -> None:
    es = ground.mission.cfe.es
    for mode in (1, 0):
        (event,) = ground.command(pk.OVER_WRITE_SYS_LOG, Mode=mode)
        assert event == f"CFE_ES 70: Set OverWriteSysLog Command Received with Mode setting = {mode}"
        assert housekeeping(ground)["SysLogMode"] == mode
        for number in range(100):
            es.write_to_sys_log(f"mode {mode} line {number:02} {'x' * 40}")
        assert (b"line 99" in log_of(ground)) == (mode == 0)
    assert ground.command(pk.OVER_WRITE_SYS_LOG, Mode=7) == [
        "CFE_ES 71: Set OverWriteSysLog Command: Invalid Mode setting = 7"
    ]
    assert housekeeping(ground)["SysLogMode"] == 0


def test_cES1015_the_log_is_cleared_by_command(ground: Ground) -> None:
    assert ground.command(pk.CLEAR_SYS_LOG) == ["CFE_ES 17: Cleared Executive Services log data"]
    values = housekeeping(ground)
    assert (values["SysLogBytesUsed"], values["SysLogEntries"]) == (0, 0)
    assert log_of(ground) == b""


def test_cES1016_the_log_is_written_to_a_file(ground: Ground) -> None:
    log = log_of(ground)
    (event,) = ground.command(pk.WRITE_SYS_LOG, FileName="/ram/log.txt")
    size, lines = 64 + len(log), log.count(b"\n")
    assert event == f"CFE_ES 18: /ram/log.txt written:Size={size},Entries={lines}"
    data = ground.file("/ram/log.txt")
    assert (read_header(data).description, read_header(data).subtype) == ("ES system log data file", 2)
    assert data[64:] == log
    assert ground.command(pk.WRITE_SYS_LOG, FileName="/nowhere/x") == [
        "CFE_ES 55: Error creating file /nowhere/x, RC = -108"
    ]
    assert ground.command(pk.WRITE_SYS_LOG, FileName="/ram/") == ["CFE_ES 55: Error parsing file name RC = 0xC6000002"]


def test_cES1016_1_system_log_file_has_a_default_name(ground: Ground) -> None:
    ground.command(pk.WRITE_SYS_LOG)
    assert ground.file("/ram/cfe_es_syslog.log")[64:] == log_of(ground)


# -- the exception and reset log ---------------------------------------------------------------------------------------


@covers("cES1017", "cES1019")
def test_cES1017_exceptions_and_resets_are_logged(ground: Ground) -> None:
    ground.mission.run_for(9)
    values = housekeeping(ground)
    assert (values["ERLogIndex"], values["ERLogEntries"]) == (2, 2)
    assert ground.command(pk.WRITE_ER_LOG, 3, FileName="er.log") == ["CFE_ES 20: /ram/er.log written:Size=7904"]
    data = ground.file("/ram/er.log")
    assert (read_header(data).description, read_header(data).subtype) == ("ES ERlog data file", 1)
    reset, exception, *rest = (
        pk.ER_LOG_FILE_ENTRY.unpack(data, at) for at in range(64, len(data), pk.ER_LOG_FILE_ENTRY.size)
    )
    assert (reset["BaseInfo"]["LogEntryType"], reset["BaseInfo"]["ResetType"]) == (1, 2)
    assert reset["BaseInfo"]["Description"] == "POWER ON RESET due to Power Cycle (Power Cycle)"
    base = exception["BaseInfo"]
    assert (base["LogEntryType"], base["ResetType"], base["ResetSubtype"], base["BootSource"]) == (2, 3, 6, 1)
    assert (base["ProcessorResetCount"], base["MaxProcessorResetCount"]) == (0, 2)
    assert base["TimeCode"]["Seconds"] == 1001008
    assert base["Description"] == "ValueError: a wheel fell off (fails.py:7)"
    context = bytes(exception["Context"][: exception["ContextSize"]])
    assert context.startswith(b"fails.py:7 ")
    assert exception["AppID"] >> 16 == 0x11
    assert len(rest) == 18
    assert all(not any(pk.ER_LOG_FILE_ENTRY.pack(entry)) for entry in rest)


def test_cES1018_the_log_is_cleared_by_command(ground: Ground) -> None:
    assert ground.command(pk.CLEAR_ER_LOG) == ["CFE_ES 19: Cleared ES Exception and Reset Log data"]
    values = housekeeping(ground)
    assert (values["ERLogIndex"], values["ERLogEntries"]) == (0, 0)
    ground.command(pk.WRITE_ER_LOG, 3)
    assert not any(ground.file("/ram/cfe_erlog.log")[64:])


def test_cES1019_only_one_write_runs_at_a_time(ground: Ground) -> None:
    ground.mission.cfe.sb.transmit_msg(pk.WRITE_ER_LOG.packet(FileName="/ram/first"))
    assert ground.command(pk.WRITE_ER_LOG, 3, FileName="/ram/second") == [
        "CFE_ES 93: Error log write already in progress",
        "CFE_ES 20: /ram/first written:Size=7904",
    ]
    assert ground.command(pk.WRITE_ER_LOG, 3, FileName="/nowhere/third") == [
        "CFE_ES 56: Error creating file /nowhere/third, RC = -108"
    ]
    assert ground.command(pk.WRITE_ER_LOG, 3, FileName="/ram/") == ["CFE_ES 56: Error creating file, RC = -973078526"]


def test_cES1019_1_exception_log_file_has_a_default_name(ground: Ground) -> None:
    ground.command(pk.WRITE_ER_LOG, 3)
    ground.command(pk.WRITE_ER_LOG, 3, FileName="/ram/mine.log")
    data = ground.file("/ram/cfe_erlog.log")
    assert data[64:] == ground.file("/ram/mine.log")[64:]
    assert b"POWER ON RESET due to Power Cycle" in data
