"""Programs that print the same on this computer and as an application of cfepy."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from cfepy.extra.c.engine import compiler
from tests.extra.c.building import console_of, fly, said, write_mission

HERE = Path(__file__).parent
FLAGS = ("-shared", "-fPIC", "-std=gnu11", "-O1", "-w", "-fno-builtin", f"-I{HERE.parent / 'libc'}")
FORTIFIED = ("-O2", "-D_FORTIFY_SOURCE=2", "-fbuiltin")
RUN = "import ctypes, os, sys; os.umask(0o022); ctypes.CDLL(sys.argv[1]).TEST_Main()"


def build(name: str, folder: Path, *flags: str) -> Path:
    """Compile a program to a shared object."""
    made = folder / "TEST.so"
    done = subprocess.run([*compiler(), *FLAGS, *flags, str(HERE / f"{name}.c"), "-o", str(made)], capture_output=True)
    assert done.returncode == 0, done.stderr
    return made


def printed_here(made: Path) -> list[str]:
    """Return the lines of a program on this computer; its current folder has a folder cf."""
    place = made.parent / "here"
    (place / "cf").mkdir(parents=True)
    command = [sys.executable, "-c", RUN, str(made)]
    done = subprocess.run(command, cwd=place, capture_output=True, stdin=subprocess.DEVNULL)
    assert done.returncode == 0, done.stderr
    return said(done.stdout.decode("utf-8", "surrogateescape"))


def compare(tmp_path: Path, name: str, *flags: str) -> None:
    """Compare the lines of a program on this computer and in flight."""
    here = printed_here(build(name, tmp_path, *flags))
    flown = said(console_of(fly(write_mission(tmp_path, "TEST"), 1)))
    assert [(one, other) for one, other in zip(here, flown, strict=False) if one != other] == []
    assert len(flown) == len(here) > 50
