"""The C compiler of this computer, called for one file or for linking."""

from __future__ import annotations

import os
import signal
import subprocess
import tempfile
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import ExitStack, suppress
from pathlib import Path
from typing import IO, NamedTuple

from cfepy.extra.c.engine import compiler
from cfepy.interpreter.host_system import is_absent
from cfepy.reading.input_limits import COMPILER_BYTES, COMPILER_SECONDS, OBJECT_BYTES
from cfepy.status import UsageError

CPP_SUFFIXES = (".cpp", ".cc", ".cxx", ".c++", ".C")
SOURCE_SUFFIXES = (".c", *CPP_SUFFIXES)
COMMON = ("-fPIC", "-Wall", "-fno-stack-protector", "-U_FORTIFY_SOURCE", "-D_LINUX_OS_", "-D_POSIX_OS_")
"""Flags of every source. The guards of distributions are left out, because they read memory of the host."""
WAITS = "the compiler was waiting for input and was ended"
_LOOK_S = 2.5  # between two looks at a running compiler; it hangs when both are the same
_MOST_LOOKS = 720  # half an hour
_ASLEEP = "S"
_USER_TIME, _SYSTEM_TIME = 9, 10  # in /proc/PID/stat, after the state and the parent
_MOST_SAID = 16 << 20  # bytes of a compiler's output
C_FLAGS = ("-std=gnu11",)
CPP_FLAGS = ("-std=gnu++17",)


class CompilerError(Exception):
    """The compiler refused a file; the text is the compiler's output."""


def cpp_compiler() -> list[str]:
    """Return the command of the C++ compiler: CXX in the environment, or c++."""
    return os.environ.get("CXX", "c++").split()


def compile_file(
    source: Path, made: Path, flags: Sequence[str], while_waiting: Callable[[], object] = lambda: None
) -> str:
    """Compile one file of C or C++ to an object file.

    Args:
        source: the file.
        made: the object file.
        flags: more flags.
        while_waiting: called every few seconds.

    Returns:
        The compiler's warnings.

    Raises:
        CompilerError: it refused the file.
        UsageError: there is no compiler.
    """
    return _call(_command(source, made, flags), while_waiting)


class CompileJob(NamedTuple):
    """A file to compile; see `compile_file`."""

    source: Path
    made: Path
    flags: Sequence[str]


def compile_files(
    jobs: Sequence[CompileJob], starts: Callable[[CompileJob], object], while_waiting: Callable[[], object]
) -> list[str]:
    """Compile files, as many at once as the computer has processors.

    Args:
        jobs: the files.
        starts: called before each file.
        while_waiting: called every few seconds.

    Returns:
        The compiler's warnings for each file.

    Raises:
        CompilerError: it refused a file; the first one in the order of the files.
        UsageError: there is no compiler.
    """
    found: list[str] = []
    waiting, running = deque(jobs), deque[tuple[subprocess.Popen[bytes], IO[bytes]]]()
    with ExitStack() as outputs:
        try:
            while waiting or running:
                while waiting and len(running) < (os.cpu_count() or 1):
                    job = waiting.popleft()
                    starts(job)
                    output: IO[bytes] = outputs.enter_context(tempfile.TemporaryFile())
                    running.append((start_bounded(_command(*job), output.fileno()), output))
                process, written = running.popleft()
                status = end_bounded(process, while_waiting)
                written.seek(0)
                said = written.read(_MOST_SAID).decode("utf-8", "replace").rstrip()
                written.close()
                if status:
                    raise CompilerError(said or f"the compiler ended with {status}")
                found.append(said)
        finally:
            for process, _ in running:  # after an error
                end_bounded(process, while_waiting)
    return found


def _command(source: Path, made: Path, flags: Sequence[str]) -> list[str]:
    command = [*cpp_compiler(), *CPP_FLAGS] if is_cpp(source) else [*compiler(), *C_FLAGS]
    return [*command, *COMMON, *flags, "-c", str(source), "-o", str(made)]


def link(objects: Sequence[Path], made: Path, flags: Sequence[str], *, with_cpp: bool) -> str:
    """Link object files to a shared object, with C++'s library if it is needed; see `compile_file`."""
    command = cpp_compiler() if with_cpp else compiler()
    return _call([*command, "-shared", *flags, *map(str, objects), "-o", str(made)])


def is_cpp(source: Path) -> bool:
    """Return True if a source is C++."""
    return source.suffix in CPP_SUFFIXES


def start_bounded(command: Sequence[str], output: int) -> subprocess.Popen[bytes]:
    """Start a compiler with limits on its resources, because a source may come from anywhere.

    Args:
        command: its command.
        output: descriptor that gets its output.

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
            preexec_fn=_bound if os.name == "posix" else None,  # on other systems only the clock limits it
        )
    except OSError as error:
        if not is_absent(command[0], error):
            raise UsageError(f"{command[0]} cannot be started: {error.strerror}") from None
        text = "is not installed; install a C compiler (on Debian `apt-get install gcc`, and g++ for C++)"
        raise UsageError(f"{command[0]} {text}, or set CC or CXX to another compiler") from None


def end_bounded(process: subprocess.Popen[bytes], while_waiting: Callable[[], object] = lambda: None) -> int:
    """Wait for the end of a compiler.

    Args:
        process: from `start_bounded`.
        while_waiting: called every few seconds.

    Returns:
        Its exit status; less than 0 when a signal ended it.

    Raises:
        CompilerError: it waited for input, such as a header that is a pipe, and was ended.
    """
    before: dict[int, tuple[str, int]] = {}
    try:
        for _ in range(_MOST_LOOKS):
            with suppress(subprocess.TimeoutExpired):
                return process.wait(_LOOK_S)
            while_waiting()
            now = _family(process.pid)
            if now and now == before and all(state == _ASLEEP for state, _ in now.values()):
                break
            before = now
        raise CompilerError(f"{WAITS}; check that no source or header is a pipe")
    finally:
        if process.returncode is None:  # also its child processes, which would stay otherwise
            for pid in (*_family(process.pid), process.pid):
                with suppress(OSError):
                    os.kill(pid, signal.SIGKILL if os.name == "posix" else signal.SIGTERM)
            process.wait()


def call_bounded(command: Sequence[str], while_waiting: Callable[[], object] = lambda: None) -> tuple[int, str]:
    """Call a compiler with limits until it ends. It raises the errors of `start_bounded` and `end_bounded`.

    Args:
        command: its command.
        while_waiting: called every few seconds.

    Returns:
        Its exit status, and its output.
    """
    with tempfile.TemporaryFile() as output:
        status = end_bounded(start_bounded(command, output.fileno()), while_waiting)
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
        resource.setrlimit(what, (min(most, held),) * 2)  # the process may have a lower limit, such as from `ulimit`


def _family(pid: int) -> dict[int, tuple[str, int]]:
    """Return state and CPU time of a process and its descendants; empty on systems without this information."""
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


def _call(command: list[str], while_waiting: Callable[[], object] = lambda: None) -> str:
    status, said = call_bounded(command, while_waiting)
    if status:
        raise CompilerError(said.rstrip() or f"{command[0]} ended with {status}")
    return said.rstrip()
