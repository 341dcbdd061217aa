"""Compiled applications for tests: C text to a shared object, and missions that fly it."""

from __future__ import annotations

import os
import shutil
import subprocess
import textwrap
from pathlib import Path

import pytest

from cfepy.extra.c.engine import compiler
from cfepy.mission import Mission
from cfepy.writing.console import Console

HERE = Path(__file__).parent
FLAGS = ("-shared", "-fPIC", "-g", "-O1", "-Wall", "-Werror", "-fno-builtin", f"-I{HERE}")

CPP = os.environ.get("CXX", "c++").split()

needs_compiler = pytest.mark.skipif(shutil.which(compiler()[0]) is None, reason="there is no C compiler")
"""For modules that compile C."""
needs_cpp = pytest.mark.skipif(shutil.which(CPP[0]) is None, reason="there is no C++ compiler")
"""For modules that compile C++."""

APP = "CFE_APP, {0}, {0}_Main, {0}, 50, 16384, 0x0, {1};\n"


def compile_c(folder: Path, name: str, source: str, *flags: str) -> Path:
    """Compile C text to `folder/NAME.so`.

    Args:
        folder: folder of the result.
        name: name of the file, without suffix.
        source: the text, with the test's indentation; `declarations.h` is included before it.
        flags: compiler flags in addition to those of all tests.
    """
    return _compile(compiler(), folder, f"{name}.c", source, flags)


def compile_cpp(folder: Path, name: str, source: str, *flags: str) -> Path:
    """Compile as `compile_c` does, for C++; functions that cFE calls are declared as extern "C" in the text."""
    return _compile(CPP, folder, f"{name}.cpp", source, flags)


def _compile(command: list[str], folder: Path, file: str, source: str, flags: tuple[str, ...]) -> Path:
    text = folder / file
    text.write_text(textwrap.dedent(source).lstrip(), encoding="utf-8")
    made = text.with_suffix(".so")
    given = [*command, *FLAGS, "-include", "declarations.h", *flags, str(text), "-o", str(made)]
    done = subprocess.run(given, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return made


def write_mission(folder: Path, *names: str, action: int = 0, libraries: str = "") -> str:
    """Write the startup script of a mission whose applications are NAME.so, with the main functions NAME_Main.

    Args:
        folder: folder of the mission.
        names: names of the applications.
        action: action after an exception: 0 restarts the application, 1 resets the processor.
        libraries: lines of libraries, which come first.

    Returns:
        The argument for `Mission`.
    """
    (folder / "startup.scr").write_text(
        libraries + "".join(APP.format(name, action) for name in names) + "!", encoding="utf-8"
    )
    return str(folder)


def make_safe(folder: Path) -> None:
    """Let the other applications of a mission go on after a fault in C, which ends NASA's process on Linux."""
    (folder / "mission.yaml").write_text("safe: true\n", encoding="utf-8")


def fly(folder: str, seconds: float = 2, tasks: str = "thread", **options: object) -> Mission:
    """Fly a mission to its end."""
    mission = Mission(folder, console=Console(quiet=True), tasks=tasks, **options)  # type: ignore[arg-type]
    try:
        mission.run_for(seconds)
    finally:
        mission.close()
    return mission


def digest_of(folder: str, tasks: str, seconds: float = 2) -> str:
    """Return the digest of a mission's trace."""
    with Mission(folder, console=Console(quiet=True), tasks=tasks) as mission:
        mission.run_for(seconds)
        return mission.finish()


def fly_c(folder: Path, source: str, seconds: float = 2, *, flags: tuple[str, ...] = (), tasks: str = "thread") -> str:
    """Fly an application TEST whose text has TEST_Main. Returns the console output."""
    compile_c(folder, "TEST", source, *flags)
    return console_of(fly(write_mission(folder, "TEST"), seconds, tasks))


def console_of(mission: Mission) -> str:
    """Return the console output of a mission."""
    return "\n".join(mission.console.lines)


def said(console: str) -> list[str]:
    """Return the lines that an application TEST wrote to the system log with the prefix "> "."""
    return [line.partition("> ")[2] for line in console.splitlines() if "> " in line]
