"""The C compiler of this computer, called for one file or for linking."""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path

from cfepy.extra.c.engine import compiler
from cfepy.interpreter.host_system import is_absent
from cfepy.reading.input_limits import COMPILER_BYTES, COMPILER_SECONDS, OBJECT_BYTES
from cfepy.status import UsageError

CPP_SUFFIXES = (".cpp", ".cc", ".cxx", ".c++", ".C")
SOURCE_SUFFIXES = (".c", *CPP_SUFFIXES)
COMMON = ("-fPIC", "-Wall", "-fno-stack-protector", "-U_FORTIFY_SOURCE", "-D_LINUX_OS_", "-D_POSIX_OS_")
"""What every source gets. The guards of distributions are left out: they look into memory that the host owns."""
WAITS = "the compiler was waiting for input and was ended"
_LOOK_S = 2.5  # from one look at a compiler that goes on to the next; it has ended when two are alike
_MOST_LOOKS = 720  # half an hour
_ASLEEP = "S"
_USER_TIME, _SYSTEM_TIME = 9, 10  # in /proc/PID/stat, behind the state and the parent
_MOST_SAID = 16 << 20  # bytes of what a compiler says
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


def start_bounded(command: Sequence[str], output: int) -> subprocess.Popen[bytes]:
    """Start a compiler, with bounds on what it takes: a source may come from anywhere.

    Args:
        command: its command.
        output: descriptor that gets what it says.

    Returns:
        The process; `end_bounded` waits for it.

    Raises:
        UsageError: there is no such program.
    """
    try:
        return subprocess.Popen(
            command,
            stdin=subprocess.DEVNULL,
            stdout=output,
            stderr=output,
            env={**os.environ, "LC_ALL": "C"},
            preexec_fn=_bound if os.name == "posix" else None,  # elsewhere the clock alone bounds it
        )
    except OSError as error:
        if not is_absent(command[0], error):
            raise UsageError(f"{command[0]} cannot be started: {error.strerror}") from None
        text = "is not installed; install a C compiler (on Debian `apt-get install gcc`, and g++ for C++)"
        raise UsageError(f"{command[0]} {text}, or set CC or CXX to another compiler") from None


def end_bounded(process: subprocess.Popen[bytes]) -> int:
    """Wait for the end of a compiler.

    Args:
        process: of `start_bounded`.

    Returns:
        Its exit status; less than 0 when a signal ended it.

    Raises:
        CompilerError: it waited for something and was ended, such as for a header that is a pipe.
    """
    before: dict[int, tuple[str, int]] = {}
    try:
        for _ in range(_MOST_LOOKS):
            with suppress(subprocess.TimeoutExpired):
                return process.wait(_LOOK_S)
            now = _family(process.pid)
            if now and now == before and all(state == _ASLEEP for state, _ in now.values()):
                break
            before = now
        raise CompilerError(f"{WAITS}; check that no source or header is a pipe")
    finally:
        if process.returncode is None:  # what it has started, too, or that would stay
            for pid in (*_family(process.pid), process.pid):
                with suppress(OSError):
                    os.kill(pid, signal.SIGKILL if os.name == "posix" else signal.SIGTERM)
            process.wait()


def call_bounded(command: Sequence[str]) -> tuple[int, str]:
    """Call a compiler, with bounds, until it ends. Errors as `start_bounded` and `end_bounded`.

    Returns:
        Its exit status, and what it said.
    """
    with tempfile.TemporaryFile() as output:
        status = end_bounded(start_bounded(command, output.fileno()))
        output.seek(0)
        return status, output.read(_MOST_SAID).decode("utf-8", "replace")


def _bound() -> None:
    import resource

    for what, most in (
        (resource.RLIMIT_CPU, COMPILER_SECONDS),
        (resource.RLIMIT_AS, COMPILER_BYTES),
        (resource.RLIMIT_FSIZE, OBJECT_BYTES),
    ):
        held = min([each for each in resource.getrlimit(what) if each != resource.RLIM_INFINITY], default=most)
        resource.setrlimit(what, (min(most, held),) * 2)  # this process may be held to less already, as by `ulimit`


def _family(pid: int) -> dict[int, tuple[str, int]]:
    """State and time of the processor of a process and all that it has started; empty where that is not told."""
    stats: dict[int, tuple[int, str, int]] = {}
    for each in Path("/proc").glob("[0-9]*"):
        try:
            state, parent, *rest = (each / "stat").read_bytes().rpartition(b")")[2].split()
        except (OSError, ValueError):
            continue
        stats[int(each.name)] = (int(parent), state.decode(), int(rest[_USER_TIME]) + int(rest[_SYSTEM_TIME]))
    found = {pid} & set(stats)
    while more := {each for each, (parent, *_) in stats.items() if parent in found} - found:
        found |= more
    return {each: stats[each][1:] for each in found}


def _call(command: list[str]) -> str:
    status, said = call_bounded(command)
    if status:
        raise CompilerError(said.rstrip() or f"{command[0]} ended with {status}")
    return said.rstrip()
