"""The apps together on a booted mission: start, scheduled commands, a table load from the ground, a restart."""

from __future__ import annotations

from collections.abc import Iterator
from functools import partial
from pathlib import Path

import pytest

from apps.sample_app.app import VERSION_TEXT
from cfepy.mission import Mission
from cfepy.msg import command
from cfepy.tbl import packets, read
from cfepy.writing.console import Console

STARTUP = """\
CFE_APP, sample_app,  SAMPLE_APP_Main, SAMPLE_APP, 50, 16384, 0x0, 0;
CFE_APP, sch_lab, SCH_LAB_AppMain, SCH_LAB,    80, 16384, 0x0, 0;
CFE_APP, hk,      HK_AppMain,      HK,         65, 16384, 0x0, 0;
!
"""
TABLE = "SAMPLE_APP.ExampleTable"
SAMPLE_STARTED = f"SAMPLE_APP 1: Sample App Initialized.{VERSION_TEXT}"


class Session:
    """A mission and an operator."""

    def __init__(self, folder: Path, tasks: str) -> None:
        (folder / "startup.scr").write_text(STARTUP, encoding="utf-8")
        self.mission = Mission(str(folder), tasks=tasks, console=Console(quiet=True))

    def events(self, seconds: int, *commands: bytes) -> list[str]:
        """Send commands and run for some virtual seconds.

        Returns the events of apps and Table Services, without times.
        """
        before = len(self.mission.console.lines)
        for packet in commands:
            self.mission.kernel.spawn("ground", partial(self.mission.cfe.sb.transmit_msg, packet, False), 10)
        self.mission.run_for(seconds)
        lines = [line.partition(" 66/1/")[2] for line in self.mission.console.lines[before:]]
        return [line for line in lines if line.startswith(("SAMPLE", "HK", "CFE_TBL"))]


@pytest.fixture(params=["thread", "greenlet"])
def session(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Session]:
    session = Session(tmp_path, request.param)
    yield session
    session.mission.close()


def test_apps_of_a_mission_exchange_commands_and_telemetry(session: Session) -> None:
    assert session.events(3)[1:] == [
        SAMPLE_STARTED,
        "HK 1: HK Initialized.  Version 7.0.0.0",
    ]
    load = packets.LOAD.packet(LoadFilename="/cf/sample_app_tbl.tbl")
    validate = packets.VALIDATE.packet(ActiveTableFlag=0, TableName=TABLE)
    activate = packets.ACTIVATE.packet(TableName=TABLE)
    assert [line.partition(":")[0] for line in session.events(3, load, validate)] == ["CFE_TBL 12", "CFE_TBL 36"]
    assert session.events(3, activate) == [f"CFE_TBL 37: SAMPLE_APP Successfully Updated '{TABLE}'"]
    where = "Dump,table=[unknown],app=,file=/ram/ex.tbl"
    dump = packets.DUMP.packet(ActiveTableFlag=1, TableName=TABLE, DumpFilename="/ram/ex.tbl")
    assert session.events(2, dump) == [f"CFE_TBL 14: {where}:Successfully dumped table"]
    assert read(session.mission.files.read_file("/ram/ex.tbl")).data == bytes([1, 0, 2, 0])


def test_restarted_app_registers_its_table_again(session: Session) -> None:
    session.mission.run_for(2)
    restart = bytes(command(0x1806, 6, b"SAMPLE_APP".ljust(20, b"\0")))
    assert session.events(9, restart)[-1] == SAMPLE_STARTED
    assert session.mission.cfe.tbl.get_info(TABLE).num_users == 1


def test_threads_and_greenlets_give_one_trace(tmp_path: Path) -> None:
    digests = set()
    for tasks in ("thread", "greenlet"):
        session = Session(tmp_path, tasks)
        session.events(5, packets.NOOP.packet())
        digests.add(session.mission.trace.digest())
        session.mission.close()
    assert len(digests) == 1
