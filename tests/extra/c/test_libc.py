"""Functions of libc: the same program prints the same on this computer and as an application."""

from __future__ import annotations

import os
import subprocess
import sys
from pathlib import Path

import pytest

from cfepy.extra.c.engine import compiler
from tests.extra.c.building import console_of, fly, needs_compiler, said, write_mission

pytestmark = needs_compiler

PROGRAMS = Path(__file__).parent / "libc"
NAMES = sorted(each.stem for each in PROGRAMS.glob("*.c"))
FLAGS = ("-shared", "-fPIC", "-std=gnu11", "-O1", "-w", "-fno-builtin", "-ffp-contract=off", "-frounding-math")
SECONDS = 1


HERE = "import ctypes, sys; ctypes.CDLL(sys.argv[1]).TEST_Main()"
"""A process that runs the object with this computer's libc; `sys.executable` also works where it is emulated."""


def build(name: str, folder: Path, *flags: str) -> Path:
    """Compile a program to a shared object."""
    made = folder / "TEST.so"
    command = [*compiler(), *FLAGS, *flags, str(PROGRAMS / f"{name}.c"), "-o", str(made), "-lm"]
    done = subprocess.run(command, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    return made


def printed_here(made: Path) -> list[str]:
    """Return the lines of a program that runs on this computer, in the locale C and in UTC."""
    environment = {"PATH": os.environ.get("PATH", ""), "LC_ALL": "C", "TZ": "UTC0"}
    command = [sys.executable, "-c", HERE, str(made)]
    done = subprocess.run(command, env=environment, capture_output=True, stdin=subprocess.DEVNULL)
    assert done.returncode == 0, done.stderr
    return said(done.stdout.decode("utf-8", "surrogateescape"))


def printed_in_flight(folder: Path, tasks: str = "thread") -> list[str]:
    """Return the lines of the program as an application."""
    return said(console_of(fly(write_mission(folder, "TEST"), SECONDS, tasks)))


OTHERWISE = {
    "fortified": ("-O2", "-D_FORTIFY_SOURCE=2", "-fbuiltin"),
    "unoptimised": ("-O0",),
}
"""Compilers call other functions then, such as __snprintf_chk."""


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("flags", OTHERWISE)
def test_program_compiled_otherwise_prints_the_same(tmp_path: Path, name: str, flags: str) -> None:
    here = printed_here(build(name, tmp_path, *OTHERWISE[flags]))
    assert here == printed_in_flight(tmp_path, "greenlet")


@pytest.mark.slow
@pytest.mark.parametrize("name", NAMES)
def test_program_prints_the_same_under_the_guard(tmp_path: Path, name: str) -> None:
    here = printed_here(build(name, tmp_path))
    (tmp_path / "mission.yaml").write_text("compiled: {guard: true}\n", encoding="utf-8")
    assert here == printed_in_flight(tmp_path)


@pytest.mark.parametrize("name", NAMES)
def test_program_prints_the_same_in_flight(tmp_path: Path, name: str) -> None:
    here, flown = printed_here(build(name, tmp_path)), printed_in_flight(tmp_path)
    assert len(here) > 5
    assert [(one, other) for one, other in zip(here, flown, strict=False) if one != other] == []
    assert len(flown) == len(here)
