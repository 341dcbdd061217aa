"""Startup scripts with odd entries, compared with the system log of NASA's cFE 7.0.0 for the same scripts."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from cfepy.es.startup_script import check
from cfepy.mission import Mission
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

IDLE = """
    def main(cfe):
        cfe.evs.register()
        while cfe.es.run_loop():
            cfe.os.task_delay(100)
        cfe.es.exit_app()

    def init(cfe):
        return 0
"""
LIB = "CFE_LIB, idle, init, LIB, 0, 0, 0x0, 0;\n"
LOAD_APP = "CFE_ES_ParseFileEntry: Loading file: /cf/idle.so, APP: "
LOAD_LIB = "CFE_ES_ParseFileEntry: Loading shared library: /cf/idle.so"
READY = ["CFE_ES_Main: CFE_ES_Main entering APPS_INIT state", "CFE_ES_Main: CFE_ES_Main entering OPERATIONAL state"]
LATE = [
    "CFE_ES_Main: Startup Sync failed - Applications may not have all initialized",
    READY[0],
    "CFE_ES_Main: Startup Sync failed - Applications may not have all started",
    READY[1],
]


def app(name: str, symbol: str = "main") -> str:
    return f"CFE_APP, idle, {symbol}, {name}, 50, 16384, 0x0, 0;\n"


CASES = {
    "name of a library": (
        LIB + app("LIB"),
        [LOAD_LIB, LOAD_APP + "LIB", "CFE_ES_LoadModule: Could not load file:/cf/idle.so. EC = -15", *READY],
    ),
    "library with the name of an application": (
        app("APP") + LIB.replace("LIB, 0", "APP, 0"),
        [LOAD_APP + "APP", LOAD_LIB, "CFE_ES_LoadLibrary: Duplicate Lib name 'APP'", *READY],
    ),
    "no name": (app(""), [LOAD_APP.rstrip(), *READY]),
    "no name twice": (
        app("") * 2,
        [LOAD_APP.rstrip(), LOAD_APP.rstrip(), "CFE_ES_AppCreate: Duplicate app name ''", *READY],
    ),
    "libraries without a name": (
        LIB.replace("LIB, 0", ", 0") * 2,
        [LOAD_LIB, LOAD_LIB, "CFE_ES_LoadLibrary: Duplicate Lib name ''", *READY],
    ),
    "application without a symbol": (app("APP", ""), [LOAD_APP + "APP", *LATE]),
    "application with the symbol NULL": (app("APP", "NULL"), [LOAD_APP + "APP", *LATE]),
    "library without a symbol": (LIB.replace("init", ""), [LOAD_LIB, *READY]),
}


@pytest.mark.parametrize("name", CASES)
def test_system_log(tmp_path: Path, name: str) -> None:
    script, expected = CASES[name]
    with Mission(write_mission(tmp_path, script + "!\n", idle=IDLE), console=Console(quiet=True)) as mission:
        mission.run_for(3)
        lines = [re.sub(r"^\d{4}-\S+ ", "", line) for line in mission.console.lines]
    begin = next(number for number, line in enumerate(lines) if "Opened ES App Startup file" in line)
    assert [line for line in lines[begin + 1 :] if line.startswith("CFE_ES_")] == expected


def test_check_reports_entries_without_names() -> None:
    notes = check((app("") + app("APP", "") + LIB.replace("LIB, 0", ", 0") + "!").encode())
    assert [note.is_warning for note in notes] == [True, True, True]
    assert [note.explanation.split(":")[0].split(";")[0] for note in notes] == [
        "the name of the application is missing",
        "the symbol is ''",
        "the name of the library is missing",
    ]
