"""Build and fly the applications of these tests, on cfepy and on NASA's cFE."""

from __future__ import annotations

import re
import subprocess
import time
from pathlib import Path

from cfepy.extra.c.engine import compiler
from cfepy.extra.c.toolchain import headers_folder
from cfepy.mission import Mission
from cfepy.writing.console import Console
from dev.twin.real import RealCfe

HERE = Path(__file__).parents[3] / "tests/extra/c/api"
FLAGS = ("-shared", "-fPIC", "-g", "-O1", "-Wall", "-Werror", "-fno-builtin", f"-I{HERE}")
ON_7_0_1 = frozenset({"odd_files", "odd_sockets", "unregistered"})
"""Recorded on cFE 7.0.1; the others are of 7.0.0."""
NAMES = sorted(each.stem for each in HERE.glob("*.c"))
STARTUP = "CFE_APP, apitest, APITEST_Main, APITEST, 50, 32768, 0x0, 0;\n!\n"
LONGEST_S = 60
END = "CFE_ES_ExitApp: Application APITEST called CFE_ES_ExitApp"
MARK = "> "
_TIME = re.compile(r"^(EVS Port1 )?\d{4}-\d{3}-\d\d:\d\d:\d\d\.\d{5} ")
_ADDRESS = re.compile(r"0x[0-9A-Fa-f]{9,}|(?<=ptr=)0x0|(?<=BufPtr )0x0")
_BY_CHANCE = re.compile(r"FLYWHEEL|No subscribers|^OS_\w+\(\):\d+|^CFE_ES_Main|^CFE_PSP|^$|STARTUP|Startup|BUG")
WITHOUT_DEPRECATED = ("-DCFE_OMIT_DEPRECATED_6_8", "-DOSAL_OMIT_DEPRECATED")


def build(name: str, folder: Path, *flags: str) -> Path:
    """Compile an application to apitest.so."""
    made = folder / "apitest.so"
    command = [*compiler(), *FLAGS, f"-I{headers_folder()}", *flags, str(HERE / f"{name}.c"), "-o", str(made)]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        raise ValueError(done.stderr)
    return made


def expected(name: str) -> list[str]:
    """Return the recorded output of an application on NASA's cFE."""
    return (HERE / f"{name}.txt").read_text(encoding="utf-8").splitlines()


def said(console: str) -> list[str]:
    """Return the system log lines of APITEST and of the services, without times and addresses."""
    lines = [_ADDRESS.sub("ADDRESS", _TIME.sub("", line)).rstrip() for line in console.splitlines()]
    first = next((number for number, line in enumerate(lines) if line.startswith(MARK)), 0)
    last = next((number for number, line in enumerate(lines) if line.startswith(END)), len(lines))
    return [line for line in lines[first:last] if not _BY_CHANCE.search(line)]


def fly(name: str, folder: Path, tasks: str = "thread", *, flags: tuple[str, ...] = (), more: str = "") -> list[str]:
    """Fly an application here.

    Args:
        name: of its file.
        folder: for the mission.
        tasks: the kind of tasks.
        flags: of the compiler.
        more: lines of the mission file.
    """
    build(name, folder, *flags)
    (folder / "startup.scr").write_text(STARTUP, encoding="utf-8")
    release = "7.0.1" if name in ON_7_0_1 else "7.0.0"
    (folder / "mission.yaml").write_text(f'cfe_version: "{release}"\n{more}', encoding="utf-8")
    with Mission(str(folder), console=Console(quiet=True), tasks=tasks) as mission:
        for _ in range(LONGEST_S):
            mission.run_for(1)
            console = "\n".join(mission.console.lines)
            if END in console:
                break
        return said(console)


def fly_on_real_cfe(name: str, built: Path, folder: Path) -> list[str]:
    """Fly an application on NASA's cFE, whose executable is in the folder `built`. Returns its log lines."""
    library = build(name, folder)
    files = {"/cf/apitest.so": library.read_bytes(), "/cf/cfe_es_startup.scr": STARTUP.encode()}
    run = folder / "run"
    run.mkdir()
    with RealCfe(built, run, files) as real:
        real.wait(lambda: END.encode() in real.console(), "end of the application", LONGEST_S)
        time.sleep(0.1)
        return said(real.console().decode(errors="replace"))
