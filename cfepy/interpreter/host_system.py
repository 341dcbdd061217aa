"""Facilities that not every operating system has; cfepy works without them where it can.

Modules that only POSIX has (`fcntl`, `termios`, `resource`) are imported in the functions that use them, never at the
top.
"""

from __future__ import annotations

import errno
import os
import signal
import sys
from collections.abc import Callable, Sequence
from typing import NoReturn

from cfepy.status import UsageError

_LOCKED_BYTE = 1 << 40
BLAS_VARIABLES = (
    "BLIS_NUM_THREADS",
    "MKL_NUM_THREADS",
    "NUMEXPR_NUM_THREADS",
    "OMP_NUM_THREADS",
    "OPENBLAS_NUM_THREADS",
    "VECLIB_MAXIMUM_THREADS",
)
"""The environment variables from which libraries of linear algebra take their number of threads."""


def ask_for_one_blas_thread() -> None:
    """Let linear algebra that NumPy loads later use one thread, in spite of the environment's variables, so that runs
    are repeatable. It also holds for NumPy outside of runs.
    """
    os.environ.update(dict.fromkeys(BLAS_VARIABLES, "1"))


def in_forked_process(call: Callable[[], object]) -> None:
    """Register a function to be called in each child that this process forks; it is never called on systems without
    fork.
    """
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(after_in_child=call)


_BEFORE_END: list[Callable[[], object]] = []


def before_end(call: Callable[[], object]) -> None:
    """Register a function that `end_process` calls first.

    Args:
        call: removes the files of this process from the computer's disks.
    """
    _BEFORE_END.append(call)


def end_process(status: int) -> NoReturn:
    """End this forked process at once, like `os._exit`, after removing the folders of its runs.

    Args:
        status: the exit status.
    """
    try:
        for call in _BEFORE_END:
            call()
    finally:
        os._exit(status)


def ending_signals() -> list[signal.Signals]:
    """Return the signals with which a user ends a program: Ctrl-C, SIGTERM, and SIGHUP unless it is ignored
    (`nohup`).
    """
    hangup = signal_number("SIGHUP")
    listens = hangup and signal.getsignal(hangup) != signal.SIG_IGN
    return [signal.SIGINT, signal.SIGTERM, *([signal.Signals(hangup)] if listens else [])]


def interrupt_once(number: int, _: object) -> None:
    """Handle SIGHUP, which a closing terminal sends twice, with exactly one KeyboardInterrupt.

    Raises:
        KeyboardInterrupt: always.
    """
    signal.signal(number, signal.SIG_IGN)
    leave_dead_terminal()
    raise KeyboardInterrupt


def leave_dead_terminal() -> bool:
    """Redirect output to a closed terminal to the null device, so that writing to it does not fail.

    Returns:
        Whether standard output or standard error was such a terminal.
    """
    was_dead = False
    for descriptor in (1, 2):
        try:
            os.get_terminal_size(descriptor)
        except OSError as error:
            if error.errno == errno.EIO:
                was_dead = True
                nowhere = os.open(os.devnull, os.O_WRONLY)
                os.dup2(nowhere, descriptor)
                os.close(nowhere)
    return was_dead


def signal_number(name: str) -> int:
    """Return the number of a signal, such as SIGBUS, or 0 if the system does not know it. No signal has the
    number 0.
    """
    return int(getattr(signal, name, 0))


def lock_file(descriptor: int) -> None:
    """Keep other processes from locking an open file, for as long as it is open.

    Raises:
        OSError: if another process has locked it.
    """
    if sys.platform != "win32":
        import fcntl

        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return
    import msvcrt

    at = os.lseek(descriptor, 0, os.SEEK_CUR)
    os.lseek(descriptor, _LOCKED_BYTE, os.SEEK_SET)  # past all data, because other processes cannot read locked bytes
    msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
    os.lseek(descriptor, at, os.SEEK_SET)


def is_absent(program: str, error: OSError) -> bool:
    """Check whether a program could not be started because it does not exist.

    Linux reports "permission denied" for a missing program if it may not search one folder of PATH.

    Args:
        program: its name or path, the first word of a command.
        error: the error from starting the command.
    """
    from shutil import which

    if isinstance(error, FileNotFoundError):
        return True
    return isinstance(error, PermissionError) and os.path.basename(program) == program and which(program) is None


def command_line(words: Sequence[str]) -> str:
    """Return a command as typed into the shell of this system."""
    if os.name == "nt":
        from subprocess import list2cmdline  # imported here because a boot would pay for it otherwise

        return list2cmdline(words)
    from shlex import join

    return join(words)


def has_own_builtins() -> bool:
    """Return whether this Python honours a module's own `__builtins__`; PyPy ignores them."""
    return eval("len", {"__builtins__": {"len": None}}) is None


def check_own_builtins() -> None:
    """Check that nodes and a mission's own applications can have their own functions in place of Python's.

    Raises:
        UsageError: if this Python gives them the real functions.
    """
    if not has_own_builtins():
        raise UsageError(
            f"{sys.implementation.name} cannot give ROS nodes and a mission's own applications separate builtins, "
            "such as `open` and `__import__`; run them with CPython. cFE and cfepy's own applications can run here"
        )
