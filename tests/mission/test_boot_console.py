"""The console of a boot against NASA's, recorded on the real system: same lines, same order.

Stand-ins that write the same lines play the apps of the recording. Executive, events, tables and clean-up are the real
ones.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.mission import Mission
from cfepy.writing.console import Console
from tests.mission.console import golden, ours

APPS = {
    "cfe_assert.py": """
        def CFE_Assert_LibInit(cfe):
            cfe.es.write_to_sys_log("[BEGIN] CFE FUNCTIONAL TEST")
            cfe.es.write_to_sys_log("[BEGIN] 01 CFE-STARTUP")
    """,
    "sample_lib.py": """
        def SAMPLE_LIB_Init(cfe):
            cfe.os.printf("SAMPLE Lib Initialized.Sample Lib v7.0.0+dev0 (Draco) v7.0.0 Official Release, EDS disabled")
    """,
    "sample_app.py": """
        def SAMPLE_APP_Main(cfe):
            cfe.evs.register()
            cfe.evs.send_info(1, "Sample App Initialized.Sample App equuleus-rc1+dev54 (Equuleus) v1.1.0"
                              " Official Release, EDS disabled")
            pipe = cfe.sb.create_pipe(5, "SAMPLE")
            while cfe.es.run_loop():
                cfe.sb.receive_buffer(pipe, -1)
    """,
    "ci_lab.py": """
        def CI_LAB_AppMain(cfe):
            cfe.es.write_to_sys_log("CI_LAB listening on UDP port: 1234")
            cfe.evs.register()
            cfe.evs.send_info(3, "CI Lab Initialized.CI Lab App v7.0.0+dev0 (Draco) v7.0.0 Official Release,"
                              " EDS disabled")
            pipe = cfe.sb.create_pipe(5, "CI_LAB")
            while cfe.es.run_loop():
                cfe.sb.receive_buffer(pipe, -1)
    """,
    "to_lab.py": """
        def TO_LAB_AppMain(cfe):
            cfe.evs.register()
            handle = cfe.tbl.register("TO_LAB_Subs", 256)
            cfe.os.task_install_delete_handler(
                lambda: cfe.os.printf("TO delete callback -- Closing TO Network socket."))
            try:
                cfe.tbl.load(handle, "/cf/to_lab_sub.tbl")
            except Exception as error:
                cfe.evs.send_err(19, f"L156 TO Can't load table status {error.status}")
            cfe.es.run_loop()
            cfe.es.exit_app(3)
    """,
    "sch_lab.py": """
        def SCH_Lab_AppMain(cfe):
            cfe.es.write_to_sys_log("SCH_LAB: Error Loading Table ScheduleTable, RC = 0xFFFFFFFFCC000020")
            cfe.es.write_to_sys_log("SCH_LAB: Error Initializing RC = 0xFFFFFFFFCC000020")
            cfe.es.exit_app(3)
    """,
}
STARTUP = """
CFE_LIB, cfe_assert, CFE_Assert_LibInit, ASSERT_LIB,   0,  0,     0x0, 0;
CFE_LIB, sample_lib, SAMPLE_LIB_Init,    SAMPLE_LIB,   0,  0,     0x0, 0;
CFE_APP, sample_app, SAMPLE_APP_Main,    SAMPLE_APP,   50, 16384, 0x0, 0;
CFE_APP, ci_lab,     CI_LAB_AppMain,     CI_LAB,       90, 16384, 0x0, 0;
CFE_APP, to_lab,     TO_LAB_AppMain,     TO_LAB,       70, 16384, 0x0, 0;
CFE_APP, sch_lab,    SCH_Lab_AppMain,    SCH_LAB,      80, 16384, 0x0, 0;
!
"""
BAD_STARTUP = """
CFE_LIB, cfe_assert, CFE_Assert_LibInit, ASSERT_LIB,   0,  0,     0x0, 0;
CFE_LIB, sample_lib, SAMPLE_LIB_Init,    SAMPLE_LIB,   0,  0,     0x0, 0;
CFE_APP, sample_app, SAMPLE_APP_Main,    SAMPLE_APP,   50, 16384, 0x0, 0;
CFE_APP, sample_app, SAMPLE_APP_Main,    SAMPLE_APP,   50, 16384, 0x0, 0;
CFE_APP, ci_lab,     CI_LAB_AppMain,     CI_LAB,       60, 16384, 0x0, 0;
CFE_APP, to_lab, short;
CFE_FOO, sample_app, SAMPLE_APP_Main,    FOO,          50, 16384, 0x0, 0;
CFE_APP, nofile,     NOFILE_Main,        NOFILE,       50, 16384, 0x0, 0;
CFE_APP, hk,         No_Such_Symbol,     NOSYM,        50, 16384, 0x0, 0;
CFE_APP, hk,         HK_AppMain,         A_NAME_THAT_IS_TOO_LONG_FOR_CFE, 50, 16384, 0x0, 0;
CFE_APP, ./bad/../name?.so, X_Main,      BADPATH,      50, 16384, 0x0, 0;
# comment;
!
"""


def flight(folder: Path, startup: str, files: dict[str, str] = APPS) -> list[str]:
    """Return the console lines of three seconds of a mission made of `files`."""
    for name, source in files.items():
        lines = source.splitlines()
        (folder / name).write_text("\n".join(line.removeprefix(" " * 8) for line in lines) + "\n", encoding="utf-8")
    (folder / "startup.scr").write_text(startup, encoding="utf-8")
    (folder / "mission.yaml").write_text('cfe_version: "7.0.0"', encoding="utf-8")
    (folder / "to_lab_sub.tbl").write_bytes(wrong_table())
    console = Console(quiet=True)
    with Mission(str(folder), console=console) as mission:
        mission.run_for(3)
    return console.lines


def wrong_table() -> bytes:
    """Return a table file of another application, as the recording had one."""
    from cfepy.tbl import TableImage, build

    return build(TableImage("TO_LAB_APP.TO_LAB_Subs", bytes(256)))


def test_boot_console_matches_nasas(tmp_path: Path) -> None:
    last = "Exit Application SCH_LAB Completed."
    assert ours(flight(tmp_path, STARTUP), last) == golden("console_boot.log", last)


def startup_texts(lines: list[str]) -> list[str]:
    wanted = ("CFE_ES_ParseFileEntry", "CFE_ES_LoadModule", "CFE_ES_AppCreate", "**WARNING**")
    return [line.partition(" ")[2] for line in lines if any(word in line for word in wanted)]


def test_bad_startup_lines_are_reported_as_by_nasas_cfe(tmp_path: Path) -> None:
    theirs = startup_texts(golden("console_bad_startup.log", "Invalid ES Startup file entry: 1"))
    found = startup_texts(flight(tmp_path, BAD_STARTUP))
    # TO_LAB of the recording, and its two malformed entries, which tests/es rebuilds byte for byte
    left_out = ("APP: TO_LAB", "**WARNING**")
    assert found == [line for line in theirs if not any(word in line for word in left_out)]


@pytest.mark.parametrize("ending", ["", "CFE_APP, sample_app, SAMPLE_APP_Main, LATE, 50, 16384, 0x0, 0"])
def test_entry_without_its_semicolon_is_ignored(tmp_path: Path, ending: str) -> None:
    lines = flight(tmp_path, STARTUP.replace("!", ending))
    assert not any("LATE" in line for line in lines)
