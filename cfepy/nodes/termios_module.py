"""`termios`, `tty`'s ground, and `fcntl` of a node: the settings of its terminal.

Descriptor 0 is the terminal of a node that has keys typed; for one without, no descriptor is a terminal. The host's
own terminal is never reached.
"""

from __future__ import annotations

import fcntl
import os
import struct
import termios
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes.streams import COLUMNS, ROWS, STDIN, descriptor
from cfepy.nodes.synth import proxy
from cfepy.nodes.terminal import Terminal

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

_STANDARD = (0, 1, 2)
_NOT_A_TERMINAL = (25, "Inappropriate ioctl for device")


def terminal_of(universe: Universe, file: Any) -> Terminal:
    """The terminal that a file is.

    Raises:
        termios.error: it is none.
    """
    number = descriptor(file)
    if universe.terminal is None or number not in _STANDARD:
        raise termios.error(*_NOT_A_TERMINAL)
    return universe.terminal


def termios_module(universe: Universe) -> ModuleType:
    """The module `termios` of a universe."""

    def tcgetattr(fd: Any) -> list[Any]:
        return terminal_of(universe, fd).attributes()

    def tcsetattr(fd: Any, when: int, attributes: list[Any]) -> None:
        terminal_of(universe, fd).set_attributes(attributes)

    def tcflush(fd: Any, queue: int) -> None:
        terminal = terminal_of(universe, fd)
        if queue != termios.TCOFLUSH:
            terminal.flush()

    def nothing(fd: Any, *args: Any) -> None:
        terminal_of(universe, fd)

    names: dict[str, Any] = dict.fromkeys(("tcdrain", "tcflow", "tcsendbreak"), nothing)
    names["tcgetwinsize"] = lambda fd: terminal_of(universe, fd) and (ROWS, COLUMNS)
    return proxy(termios, tcgetattr=tcgetattr, tcsetattr=tcsetattr, tcflush=tcflush, tcsetwinsize=nothing, **names)


def fcntl_module(universe: Universe) -> ModuleType:
    """The module `fcntl` of a universe: the host's for files, the terminal's settings for 0, 1 and 2."""

    def control(fd: Any, command: int, argument: Any = 0) -> Any:
        if descriptor(fd) not in _STANDARD:
            return fcntl.fcntl(fd, command, argument)
        terminal = universe.terminal
        if command == fcntl.F_SETFL and terminal is not None and descriptor(fd) == STDIN:
            terminal.blocking = not argument & os.O_NONBLOCK
        if command != fcntl.F_GETFL:
            return 0
        return os.O_RDWR if terminal is None or terminal.blocking else os.O_RDWR | os.O_NONBLOCK

    def ioctl(fd: Any, request: int, argument: Any = 0, mutate: bool = True) -> Any:
        if descriptor(fd) not in _STANDARD:
            return fcntl.ioctl(fd, request, argument, mutate)
        if universe.terminal is None:
            raise OSError(*_NOT_A_TERMINAL)
        return _answer(request, argument, universe.terminal)

    return proxy(fcntl, fcntl=control, ioctl=ioctl)


def _answer(request: int, argument: Any, terminal: Terminal) -> Any:
    """What a terminal says to TIOCGWINSZ (its size) and FIONREAD (whether there is something to read)."""
    if request == termios.TIOCGWINSZ:
        answer = struct.pack("HHHH", ROWS, COLUMNS, 0, 0)
    elif request == termios.FIONREAD:
        answer = struct.pack("i", terminal.available)
    else:
        return 0
    if isinstance(argument, (bytearray, memoryview)) or hasattr(argument, "buffer_info"):
        memoryview(argument).cast("B")[: len(answer)] = answer
        return 0
    return answer
