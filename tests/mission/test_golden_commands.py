"""Ground commands recorded on the real cFE, byte for byte, and the events they caused there: ours are the same."""

from __future__ import annotations

import json
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from cfepy.console import Console
from cfepy.mission import Mission
from tests.mission.flights import write_mission

COMMANDS: list[dict[str, Any]] = json.loads((Path(__file__).parents[1] / "data" / "command_events.json").read_text())
STARTUP = """
    CFE_APP, sample, SAMPLE_APP_Main, SAMPLE_APP, 50, 16384, 0x0, 0;
    CFE_APP, ci_lab, CI_LAB_AppMain, CI_LAB, 60, 16384, 0x0, 0;
    CFE_APP, to_lab, TO_LAB_AppMain, TO_LAB, 70, 16384, 0x0, 0;
    CFE_APP, sch_lab, SCH_LAB_AppMain, SCH_LAB, 80, 16384, 0x0, 0;
    CFE_APP, hk,     HK_AppMain,      HK,         90, 16384, 0x0, 0;
    !
"""
NOT_HERE_YET = {
    "ES QUERY_ALL": "ES writes no files yet",
    "ES WRITE_SYS_LOG": "ES writes no files yet",
    "ES WRITE_ER_LOG": "ES writes no files yet",
    "ES DUMP_CDS_REGISTRY": "there is no CDS yet",
    "SB WRITE_": "SB writes no files yet",
}
DIFFERENT = {
    "TBL LOAD": "cFE v7.0.0 cannot load from the ground; fixed in v7.0.1 and here",
    "TBL DUMP active": "gave no event and no file there, for a reason that is not known",
    "TBL VALIDATE": "follows from the load that failed there",
    "TBL ACTIVATE": "follows from the load that failed there",
    "ES RESTART_CFE": "ends the run",
    "ES START_APP": "its file's table is another app's; the order of two events differs",
}
BY_THE_WAY = ("CFE_SB 14:", "CFE_SB 17:")  # nobody hears SCH_LAB's request, or SAMPLE_APP does not while it ends
STAMP = re.compile(r"^EVS Port1 \S+ 66/1/")
MASKS = [
    (re.compile(r"Build .*"), "Build <build>"),
    (re.compile(r"(Sample App Initialized\.Sample App|SAMPLE: NOOP command) .*"), r"\1 <version>"),
    (re.compile(r"AppID=\d+"), "AppID=<id>"),
]


def comparable(event: str) -> str:
    for pattern, replacement in MASKS:
        event = pattern.sub(replacement, event)
    return event


def applies(command: dict[str, Any]) -> bool:
    return not any(command["desc"].startswith(name) for name in (*NOT_HERE_YET, *DIFFERENT))


@pytest.fixture(scope="module")
def mission(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Mission]:
    folder = write_mission(tmp_path_factory.mktemp("golden"), STARTUP)
    with Mission(folder, console=Console(quiet=True)) as mission:
        mission.run(3)
        yield mission


APPLICABLE = [command for command in COMMANDS if applies(command)]


@pytest.mark.parametrize("command", APPLICABLE, ids=lambda command: command["desc"][:40])
def test_command_causes_the_recorded_events(mission: Mission, command: dict[str, Any]) -> None:
    before = len(mission.console.lines)
    mission.cfe.sb.transmit_msg(bytes.fromhex(command["hex"]), is_origination=False)
    mission.run(8 if "_APP" in command["desc"] else 1)
    events = [STAMP.sub("", line) for line in mission.console.lines[before:] if STAMP.match(line)]
    assert [comparable(event) for event in events if not event.startswith(BY_THE_WAY)] == [
        comparable(event) for event in command["events"]
    ]


def test_most_commands_are_compared() -> None:
    assert len(APPLICABLE) >= 25
