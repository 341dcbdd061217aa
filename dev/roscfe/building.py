"""Compile programs in C++ against the interface library, for this computer or for another one."""

from __future__ import annotations

import os
import shutil
import subprocess
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

import pytest

from cfepy.reading.resources import shipped

CPP = os.environ.get("CXX", "c++").split()
ROSCFE = shipped("roscfe")
INCLUDE = tuple(f"-I{ROSCFE / name}" for name in ("include", "threads", "boost"))
STRICT_FLAGS = ("-std=c++17", "-Wall", "-Wextra", "-Werror")
FLIGHT_FLAGS = (*STRICT_FLAGS, "-fno-exceptions", "-fno-rtti")

SYSTEM = Path("/usr/include")
ROSCPP = ("-lrostime", "-lroscpp_serialization")
"""Libraries of roscpp's own headers, which Debian has (libroscpp-dev)."""

needs_cpp = pytest.mark.skipif(shutil.which(CPP[0]) is None, reason="there is no C++ compiler")
"""For modules that compile C++."""


class Target(NamedTuple):
    """A kind of computer: how to compile programs for it, and how to run them here."""

    compiler: tuple[str, ...]
    runner: tuple[str, ...] = ()

    @property
    def lacking(self) -> str | None:
        """The first command that is not there."""
        words = (self.compiler[0], *self.runner[:1])
        return next((word for word in words if shutil.which(word) is None), None)


HERE = Target(tuple(CPP))
POWERPC = Target(("powerpc-linux-gnu-g++", "-static"), ("qemu-ppc",))
ARM = Target(("arm-linux-gnueabihf-g++", "-static"), ("qemu-arm",))
MIPS = Target(("mips-linux-gnu-g++", "-static"), ("qemu-mips",))
TARGETS = {"here": HERE, "powerpc": POWERPC, "arm": ARM, "mips": MIPS}
"""Those that are emulated have 32 bits; powerpc and mips are big-endian."""


def target_named(name: str) -> Target:
    """Return a kind of computer for a test, which is skipped where its compiler or its emulator is not there."""
    lacking = TARGETS[name].lacking
    if lacking is not None:
        pytest.skip(f"there is no {lacking} (Debian: qemu-user, g++-arm-linux-gnueabihf, ...)")
    return TARGETS[name]


def compile_program(
    made: Path,
    sources: Iterable[Path],
    *flags: str,
    target: Target = HERE,
    base: Sequence[str] = FLIGHT_FLAGS,
    include: Sequence[str] = INCLUDE,
    libraries: Sequence[str] = (),
) -> Path:
    """Compile C++ files one by one, and link them.

    Args:
        made: the resulting program.
        sources: the files.
        flags: further compiler flags, such as include paths and -O1.
        target: the target computer.
        base: language and warnings.
        include: folders of headers; empty for roscpp's own.
        libraries: libraries to link.
    """
    objects = compile_objects(made, sources, *flags, target=target, base=base, include=include)
    return link_program(made, objects, *flags, *libraries, target=target)


def compile_objects(
    made: Path,
    sources: Iterable[Path],
    *flags: str,
    target: Target = HERE,
    base: Sequence[str] = FLIGHT_FLAGS,
    include: Sequence[str] = INCLUDE,
) -> list[Path]:
    """Compile C++ files one by one to object files, named after them and `made`; see `compile_program`."""
    objects = []
    for source in sources:
        objects.append(made.with_name(f"{source.stem}.{made.name}.o"))
        _run([*target.compiler, *base, *include, *flags, "-c", str(source), "-o", str(objects[-1])])
    return objects


def link_program(made: Path, objects: Iterable[Path], *flags: str, target: Target = HERE) -> Path:
    """Link object files. Flags are the linker's, including libraries."""
    _run([*target.compiler, *map(str, objects), *flags, "-o", str(made)])
    return made


def complaints(folder: Path, text: str, *flags: str, base: Sequence[str] = FLIGHT_FLAGS) -> str:
    """Return the compiler's messages about a text, or nothing if it compiles."""
    source = folder / "text.cpp"
    source.write_text(text, encoding="utf-8")
    command = [*CPP, *base, *INCLUDE, *flags, "-fsyntax-only", str(source)]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert bool(done.returncode) == bool(done.stderr), done
    return done.stderr


def _run(command: list[str]) -> None:
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr[:4000]
