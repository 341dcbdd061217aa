"""Accesses of a mission that bypass the simulated computer: C code and installed packages reach the host directly.

Python's audit hooks report them. Actions that cfepy and Python perform for a mission, such as an import, are left out.
An access counts if a line of the mission's own code causes it, directly or through a package.
"""

from __future__ import annotations

import os
import sys
import tempfile
from functools import cache
from types import FrameType
from typing import Any

from cfepy.interpreter.own_code import is_own_code
from cfepy.nodes import MADE, PREFIX
from cfepy.pilot.determinism_look import place_text

_WRITES = os.O_WRONLY | os.O_RDWR | os.O_CREAT
_CHANGES = frozenset({"os.link", "os.mkdir", "os.remove", "os.rename", "os.rmdir", "os.symlink", "os.truncate"})
_ANSWERS = ("/proc/", "/sys/", "/dev/random", "/dev/urandom")  # different at each time
_SAME = ("/dev/null", "/dev/zero", "/dev/full")
_IMPORTS = "<frozen importlib"
_OF_LIBC = {
    **dict.fromkeys(("arc4random", "getentropy", "getrandom", "rand", "random"), "draws random numbers"),
    **dict.fromkeys(("clock", "clock_gettime", "ftime", "gettimeofday", "time", "times"), "asks the clock"),
    **dict.fromkeys(("getpid", "gettid", "getppid"), "asks for a number of the process"),
    **dict.fromkeys(("nanosleep", "poll", "pselect", "select", "sleep", "usleep"), "waits in real time"),
    **dict.fromkeys(("malloc", "sbrk"), "uses an address"),
}
"""Functions of libc with another result in each run, by name."""
MOST = 100  # maximum number of accesses kept


class OpenWorld:
    """Records accesses to the host; a context manager around a run.

    Attributes:
        contacts: each access once, as text with the line of code.
    """

    def __init__(self) -> None:
        self.contacts: dict[str, None] = {}
        self._own: tuple[str, ...] = ()

    def __enter__(self) -> OpenWorld:
        # determined now, because it creates and removes a file, which must not happen during a node's work
        tempfile.gettempdir()
        _listeners().append(self)
        return self

    def __exit__(self, *error: object) -> None:
        _listeners().remove(self)

    def told(self, event: str, values: tuple[Any, ...]) -> None:
        """Handle an audit event of this process."""
        if event == MADE:
            self._own += (os.path.join(values[0], ""),)
            return
        what = self._contact(event, values)
        if what is None or len(self.contacts) >= MOST:
            return
        frame = _asking(sys._getframe(2))
        if frame is not None:
            self.contacts[f"{place_text(frame)}: {what}"] = None

    def _contact(self, event: str, values: tuple[Any, ...]) -> str | None:
        if event == "ctypes.dlopen":
            return f"loads {values[0]}, whose code nothing holds" if values[0] else None
        if event == "ctypes.dlsym":
            action = _OF_LIBC.get(str(values[1]))
            return None if action is None else f"{action} of this computer by {values[1]} of libc"
        if not values or not isinstance(values[0], (str, bytes, os.PathLike)):
            return None
        path = os.path.abspath(os.fsdecode(values[0]))
        if os.path.basename(path).startswith(PREFIX) or path.startswith(self._own):
            return None
        if event in _CHANGES:
            return f"changes {path} on this computer"
        if event == "open" and path not in _SAME:
            if path.startswith(_ANSWERS):
                return f"reads {path}, which is another each time"
            if values[2] & _WRITES:
                return f"writes {path} on this computer"
        return None


def _asking(frame: FrameType | None) -> FrameType | None:
    """Return the frame of the mission's own code that causes an action; None if there is none, or an import
    causes it.
    """
    while frame is not None:
        file = frame.f_code.co_filename
        if file.startswith(_IMPORTS):
            return None
        if is_own_code(file):
            return frame
        frame = frame.f_back
    return None


@cache
def _listeners() -> list[OpenWorld]:
    """Return the listeners of the only hook of this process, which cannot be removed."""
    found: list[OpenWorld] = []

    def hook(event: str, values: tuple[Any, ...]) -> None:
        if found and (event in _CHANGES or event in ("open", "ctypes.dlopen", "ctypes.dlsym", MADE)):
            for each in tuple(found):
                each.told(event, values)

    sys.addaudithook(hook)
    return found
