"""The C compiler of this computer, called for one file or for linking."""

from __future__ import annotations

import os
import subprocess
from collections.abc import Sequence
from pathlib import Path

from cfepy.c.engine import compiler
from cfepy.host_system import is_absent
from cfepy.status import UsageError

CPP_SUFFIXES = (".cpp", ".cc", ".cxx", ".c++", ".C")
SOURCE_SUFFIXES = (".c", *CPP_SUFFIXES)
COMMON = ("-fPIC", "-Wall", "-fno-stack-protector", "-U_FORTIFY_SOURCE", "-D_LINUX_OS_", "-D_POSIX_OS_")
"""What every source gets. The guards of distributions are left out: they look into memory that the host owns."""
C_FLAGS = ("-std=gnu11",)
CPP_FLAGS = ("-std=gnu++17",)


class CompilerError(Exception):
    """The compiler refused a file; the text is what it said."""


def cpp_compiler() -> list[str]:
    """The command of the C++ compiler: CXX in the environment, or c++."""
    return os.environ.get("CXX", "c++").split()


def compile_file(source: Path, made: Path, flags: Sequence[str]) -> str:
    """Compile one file of C or C++ to an object file.

    Args:
        source: the file.
        made: the object file.
        flags: more flags.

    Returns:
        What the compiler warned of.

    Raises:
        CompilerError: it refused the file.
        UsageError: there is no compiler.
    """
    command = [*cpp_compiler(), *CPP_FLAGS] if is_cpp(source) else [*compiler(), *C_FLAGS]
    return _call([*command, *COMMON, *flags, "-c", str(source), "-o", str(made)])


def link(objects: Sequence[Path], made: Path, flags: Sequence[str], *, with_cpp: bool) -> str:
    """Link object files to a shared object, with C++'s library when it is needed; see `compile_file`."""
    command = cpp_compiler() if with_cpp else compiler()
    return _call([*command, "-shared", *flags, *map(str, objects), "-o", str(made)])


def is_cpp(source: Path) -> bool:
    """Whether a source is C++."""
    return source.suffix in CPP_SUFFIXES


def _call(command: list[str]) -> str:
    try:
        done = subprocess.run(command, capture_output=True, text=True, errors="replace", check=False)
    except OSError as error:
        if not is_absent(command[0], error):
            raise UsageError(f"{command[0]} cannot be started: {error.strerror}") from None
        text = "is not there: install a C compiler (on Debian `apt-get install gcc`, and g++ for C++)"
        raise UsageError(f"{command[0]} {text}, or say with CC or CXX which one to take") from None
    if done.returncode:
        raise CompilerError(done.stderr.rstrip() or f"{command[0]} ended with {done.returncode}")
    return done.stderr.rstrip()
