"""What of the computer's system not every system has; without it, cfepy goes on where it can.

Modules that only POSIX has (`fcntl`, `termios`, `resource`) are imported where they are used, and never at the top.
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


def in_forked_process(call: Callable[[], object]) -> None:
    """Call something in each child that this process forks; where no process is forked, never."""
    if hasattr(os, "register_at_fork"):
        os.register_at_fork(after_in_child=call)


_BEFORE_END: list[Callable[[], object]] = []


def before_end(call: Callable[[], object]) -> None:
    """Have `end_process` call something first.

    Args:
        call: removes what this process has on the computer's disks.
    """
    _BEFORE_END.append(call)


def end_process(status: int) -> NoReturn:
    """End this forked process at once, as `os._exit` does, and remove the folders of its runs before.

    Args:
        status: the exit status.
    """
    try:
        for call in _BEFORE_END:
            call()
    finally:
        os._exit(status)


def ending_signals() -> list[signal.Signals]:
    """The signals by which a user ends a program: Ctrl-C, SIGTERM, and SIGHUP where it is not ignored (`nohup`)."""
    hangup = signal_number("SIGHUP")
    listens = hangup and signal.getsignal(hangup) != signal.SIG_IGN
    return [signal.SIGINT, signal.SIGTERM, *([signal.Signals(hangup)] if listens else [])]


def interrupt_once(number: int, _: object) -> None:
    """An answer to SIGHUP, which a terminal that is closed sends twice: a KeyboardInterrupt, and no other.

    Raises:
        KeyboardInterrupt: always.
    """
    signal.signal(number, signal.SIG_IGN)
    leave_dead_terminal()
    raise KeyboardInterrupt


def leave_dead_terminal() -> bool:
    """Let what goes to a terminal that was closed go nowhere, so that writing to it does not fail.

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
    """The number of a signal, such as SIGBUS; 0, which no signal has, where the system does not know it."""
    return int(getattr(signal, name, 0))


def lock_file(descriptor: int) -> None:
    """Keep other processes from locking an open file too, for as long as it is open.

    Raises:
        OSError: another one has locked it.
    """
    if sys.platform != "win32":
        import fcntl

        fcntl.flock(descriptor, fcntl.LOCK_EX | fcntl.LOCK_NB)
        return
    import msvcrt

    at = os.lseek(descriptor, 0, os.SEEK_CUR)
    os.lseek(descriptor, _LOCKED_BYTE, os.SEEK_SET)  # behind all data: nobody can read what is locked
    msvcrt.locking(descriptor, msvcrt.LK_NBLCK, 1)
    os.lseek(descriptor, at, os.SEEK_SET)


def is_absent(program: str, error: OSError) -> bool:
    """Check whether a program could not be started because there is none of that name.

    Linux answers "permission denied" for a missing program if one folder of PATH may not be searched.

    Args:
        program: its name or path, the first word of a command.
        error: raised when the command was started.
    """
    from shutil import which

    if isinstance(error, FileNotFoundError):
        return True
    return isinstance(error, PermissionError) and os.path.basename(program) == program and which(program) is None


def command_line(words: Sequence[str]) -> str:
    """A command as it is typed into the shell of this system."""
    if os.name == "nt":
        from subprocess import list2cmdline  # starting with it would cost every boot its import

        return list2cmdline(words)
    from shlex import join

    return join(words)


def has_own_builtins() -> bool:
    """Whether `__builtins__` of a module's own count in this Python; PyPy leaves them aside."""
    return eval("len", {"__builtins__": {"len": None}}) is None


def check_own_builtins() -> None:
    """That nodes, and applications of a mission's own, can have functions of their own in place of Python's.

    Raises:
        UsageError: this Python gives them those of the computer.
    """
    if not has_own_builtins():
        raise UsageError(
            f"{sys.implementation.name} cannot give ROS nodes and a mission's own applications separate builtins, "
            "such as `open` and `__import__`; run them with CPython. cFE and cfepy's own applications can run here"
        )
