"""Every file that the core services of a mission write on command, read back by `cfepy.ground.cfe_files.dump_files`."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.es import packets as es
from cfepy.evs import packets as evs
from cfepy.ground.cfe_files.dump_files import DumpFile, read_dump, timings
from cfepy.mission import Mission
from cfepy.sb import packets as sb
from cfepy.tbl import packets as tbl
from cfepy.writing.console import Console

STARTUP = "CFE_APP, sample_app, SAMPLE_APP_Main, SAMPLE_APP, 50, 16384, 0x0, 0;\n!\n"
SAMPLE_NOOP, SAMPLE_PERF_ID = bytes.fromhex("1882c00000010000"), 91
COMMANDS = {
    "events": evs.WRITE_LOG_DATA_FILE.packet(LogFilename="/ram/events"),
    "event_apps": evs.WRITE_APP_DATA_FILE.packet(AppDataFilename="/ram/event_apps"),
    "apps": es.QUERY_ALL.packet(FileName="/ram/apps"),
    "tasks": es.QUERY_ALL_TASKS.packet(FileName="/ram/tasks"),
    "syslog": es.WRITE_SYS_LOG.packet(FileName="/ram/syslog"),
    "erlog": es.WRITE_ER_LOG.packet(FileName="/ram/erlog"),
    "cds": es.DUMP_CDS_REGISTRY.packet(DumpFilename="/ram/cds"),
    "perf": es.STOP_PERF_DATA.packet(DataFileName="/ram/perf"),
    "routes": sb.WRITE_ROUTING_INFO.packet(Filename="/ram/routes"),
    "pipes": sb.WRITE_PIPE_INFO.packet(Filename="/ram/pipes"),
    "map": sb.WRITE_MAP_INFO.packet(Filename="/ram/map"),
    "tables": tbl.DUMP_REGISTRY.packet(DumpFilename="/ram/tables"),
}


@pytest.fixture(scope="module")
def dumps(tmp_path_factory: pytest.TempPathFactory) -> dict[str, DumpFile]:
    """Return the contents of one run's files."""
    folder: Path = tmp_path_factory.mktemp("mission")
    (folder / "startup.scr").write_text(STARTUP, encoding="utf-8")
    with Mission(str(folder), console=Console(quiet=True)) as mission:
        mission.run_for(2)
        mission.cfe.sb.transmit_msg(es.START_PERF_DATA.packet())
        mission.run_for(1)
        mission.cfe.sb.transmit_msg(SAMPLE_NOOP)
        for command in COMMANDS.values():
            mission.run_for(2)
            mission.cfe.sb.transmit_msg(command)
        mission.run_for(20)
        files = {path.removeprefix("/ram/"): data for path, data in mission.files.written().items()}
    return {name: read_dump(files[name], name) for name in COMMANDS}


def test_dump_files_are_complete(dumps: dict[str, DumpFile]) -> None:
    assert {name: dump.problem for name, dump in dumps.items()} == dict.fromkeys(COMMANDS, "")
    assert len({dump.kind for dump in dumps.values()}) == len(COMMANDS)


def test_dump_files_have_the_expected_records(dumps: dict[str, DumpFile]) -> None:
    assert dumps["events"].records[0]["Message"].startswith("cFE ES Initialized: ")
    assert [row["AppName"] for row in dumps["event_apps"].records][-1] == "SAMPLE_APP"
    assert [row["Name"] for row in dumps["apps"].records if row["Type"] == 2] == ["SAMPLE_APP"]
    assert "ES_BG_TASK" in [row["TaskName"] for row in dumps["tasks"].records]
    assert any("entering OPERATIONAL state" in line for line in dumps["syslog"].lines)
    assert dumps["erlog"].records[0]["BaseInfo"]["ResetType"] == 2
    assert "CFE_TBL.CritReg" in [row["Name"] for row in dumps["cds"].records]
    assert {row["PipeName"] for row in dumps["routes"].records} == {row["PipeName"] for row in dumps["pipes"].records}
    assert len(dumps["map"].records) == len(dumps["routes"].records)
    assert [row["Name"] for row in dumps["tables"].records] == ["SAMPLE_APP.ExampleTable"]


def test_performance_of_the_sample(dumps: dict[str, DumpFile]) -> None:
    assert len(timings(dumps["perf"].records)[SAMPLE_PERF_ID].taken_us) == 1
