"""A full RAM disk: every command that writes a file reports it with NASA's event, and the mission continues."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from cfepy.es import packets as es
from cfepy.evs import packets as evs
from cfepy.mission import Mission
from cfepy.msg import Command
from cfepy.sb import packets as sb
from cfepy.tbl import packets as tbl
from cfepy.writing.console import Console

BLOCK = 512
FILE = "/ram/d.dat"
HEADER_FAILED = {
    es.QUERY_ALL: ("FileName", "CFE_ES 52: Failed to write App Info file, WriteHdr RC = 0xC8000005, exp 64"),
    es.QUERY_ALL_TASKS: ("FileName", "CFE_ES 89: Failed to write Task Info file, WriteHdr RC = 0xC8000005, exp 64"),
    es.WRITE_SYS_LOG: ("FileName", f"CFE_ES 74: File write,byte cnt err,file {FILE},request=64,status=0xc8000005"),
    es.WRITE_ER_LOG: ("FileName", f"CFE_ES 74: File write,byte cnt err,file {FILE},request=64,actual=3355443205"),
    es.STOP_PERF_DATA: ("DataFileName", f"CFE_ES 74: File write,byte cnt err,file {FILE},request=64,status=0xc8000005"),
    es.DUMP_CDS_REGISTRY: ("DumpFilename", f"CFE_ES 85: Error writing cFE File Header to '{FILE}', Status=0xC8000005"),
    evs.WRITE_LOG_DATA_FILE: (
        "LogFilename",
        f"CFE_EVS 14: Write File Header to Log File Error: WriteHdr RC: -939524091, Expected: 64, filename = {FILE}",
    ),
    sb.WRITE_ROUTING_INFO: ("Filename", f"CFE_SB 49: File write,byte cnt err,file {FILE},request=64,actual=-939524091"),
    sb.WRITE_PIPE_INFO: ("Filename", f"CFE_SB 49: File write,byte cnt err,file {FILE},request=64,actual=-939524091"),
    sb.WRITE_MAP_INFO: ("Filename", f"CFE_SB 49: File write,byte cnt err,file {FILE},request=64,actual=-939524091"),
    tbl.DUMP_REGISTRY: ("DumpFilename", f"CFE_TBL 63: Error writing cFE File Header to '{FILE}', Status=0xC8000005"),
}


def fill(mission: Mission, blocks_left: int = 0) -> None:
    """Fill the RAM disk up to some blocks."""
    free = mission.cfe.os.file_sys_stat_volume("/ram").blocks_free
    mission.files.write_file("/ram/ballast", bytes(BLOCK * (free - blocks_left)))


def send(mission: Mission, command: Command, **values: object) -> list[str]:
    """Send a command, and wait for its file. Returns the events."""
    mission.console.lines.clear()
    mission.cfe.sb.transmit_msg(command.packet(values))
    mission.run_for(8)
    assert mission.record.resets == []
    return [line.partition("66/1/")[2] for line in mission.console.lines if line.startswith("EVS")]


@pytest.fixture(scope="module")
def full() -> Iterator[Mission]:
    with Mission("lab", console=Console(quiet=True)) as mission:
        mission.run_for(3)
        fill(mission)
        yield mission


@pytest.mark.parametrize("command", HEADER_FAILED, ids=lambda command: command.name)
def test_missing_space_for_the_header_is_reported(full: Mission, command: Command) -> None:
    field, event = HEADER_FAILED[command]
    assert event in send(full, command, **{field: FILE})


@pytest.mark.parametrize(
    ("blocks", "event"),
    [
        (0, "63: Dump,{}:Error writing cFE File Header, Status=0xC8000005"),
        (1, "65: Dump,{}:Error writing Tbl image, Status=-1"),
        (5, "14: Dump,{}:Successfully dumped table"),
    ],
)
def test_a_table_of_several_blocks(blocks: int, event: str) -> None:
    with Mission("lab", console=Console(quiet=True)) as mission:
        mission.run_for(3)
        fill(mission, blocks)
        events = send(mission, tbl.DUMP, TableName="HK.CopyTable", DumpFilename=FILE, ActiveTableFlag=1)
        assert "CFE_TBL " + event.format(f"table=[unknown],app=,file={FILE}") in events
