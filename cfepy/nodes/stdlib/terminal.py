"""Terminal from which a node is started, and `termios` and `fcntl`, with which the node configures it.

It replaces the pseudo-terminal that a program has as file descriptor 0 when a user starts it by hand. Keys are typed
at virtual times. Cooked mode collects lines, lets the user correct them and turns Ctrl-C into SIGINT. Raw and cbreak
modes pass on each key. Input is not echoed, because the output of two writers would be mixed on one console. For a node
without keys, no descriptor is a terminal. The host's own terminal is never used.
"""

from __future__ import annotations

import fcntl
import os
import signal
import struct
import termios
from collections.abc import Callable, Sequence
from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes.made_modules import proxy
from cfepy.nodes.stdlib.locks import wait_ns
from cfepy.nodes.stdlib.streams import COLUMNS, ROWS, STDIN, descriptor
from cfepy.rtos import FOREVER, TIMEOUT, WaitList

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

Key = str | float
KEY_GAP_S = 0.1  # between two keys: a fast typist
IFLAG, OFLAG, CFLAG, LFLAG, ISPEED, OSPEED, CC = range(7)  # indices in the result of `termios.tcgetattr`
_SIGNALS = {"VINTR": signal.SIGINT, "VQUIT": signal.SIGQUIT}
_CONTROLS = {"VINTR": b"\x03", "VQUIT": b"\x1c", "VERASE": b"\x7f", "VKILL": b"\x15", "VEOF": b"\x04", "VMIN": b"\x01"}
_VTIME_S = 0.1
_STANDARD = (0, 1, 2)
_NOT_A_TERMINAL = (25, "Inappropriate ioctl for device")


def cooked_attributes() -> list[Any]:
    """Return the result of `termios.tcgetattr` for a terminal whose settings were never changed."""
    controls: list[Any] = [b"\x00"] * 32
    for name, character in _CONTROLS.items():
        controls[getattr(termios, name)] = character
    iflag = termios.ICRNL | termios.IXON | termios.BRKINT
    lflag = termios.ICANON | termios.ISIG | termios.ECHO | termios.ECHOE | termios.ECHOK | termios.IEXTEN
    cflag = termios.CS8 | termios.CREAD
    return [iflag, termios.OPOST | termios.ONLCR, cflag, lflag, termios.B38400, termios.B38400, controls]


class Terminal:
    """A terminal, as seen by the node that runs on it.

    Args:
        universe: universe of the node.
        keys: texts and numbers in the order of typing. Each text is typed at once, 0.1 s after the item before it. A
            number is an additional wait in seconds.
        on_signal: called with SIGINT or SIGQUIT when its key, such as Ctrl-C, is typed in cooked mode.
    """

    def __init__(self, universe: Universe, keys: Sequence[Key], on_signal: Callable[[int], object]) -> None:
        self.blocking = True
        self.waits = WaitList(f"a key in {universe.name}")
        self._universe = universe
        self._keys = keys
        self._on_signal = on_signal
        self._attributes = cooked_attributes()
        self._chunks: list[bytes] = []  # ready to be read; an empty one means end of file
        self._line = bytearray()  # begun in cooked mode

    # -- the keyboard ------------------------------------------------------------------------------------------------

    def start_typing(self) -> None:
        """Have the keys typed from now on by a task of the node."""
        self._universe.start_thread(self._type_all)

    def _type_all(self) -> None:
        for key in self._keys:
            self._universe.clock.wait(KEY_GAP_S if isinstance(key, str) else key)
            if isinstance(key, str):
                self.take(key.encode())

    def take(self, typed: bytes) -> None:
        """Receive bytes from the keyboard, all at once."""
        for value in typed:
            self._take_one(bytes((value,)))
        if self._chunks:
            self._universe.kernel.wake_all(self.waits)

    def _take_one(self, char: bytes) -> None:
        lflag, controls = self._attributes[LFLAG], self._attributes[CC]
        if char == b"\r" and self._attributes[IFLAG] & termios.ICRNL:
            char = b"\n"
        if lflag & termios.ISIG:
            for name, number in _SIGNALS.items():
                if char == controls[getattr(termios, name)]:
                    self.flush()
                    self._on_signal(number)
                    return
        if lflag & termios.ICANON:
            self._edit(char, controls)
        else:
            self._chunks.append(char)

    def _edit(self, char: bytes, controls: Sequence[Any]) -> None:
        if char in (controls[termios.VERASE], b"\b"):
            del self._line[-1:]
        elif char == controls[termios.VKILL]:
            self._line.clear()
        elif char == controls[termios.VEOF]:
            self._end_line()
        else:
            self._line += char
            if char == b"\n":
                self._end_line()

    def _end_line(self) -> None:
        self._chunks.append(bytes(self._line))
        self._line.clear()

    # -- the node ----------------------------------------------------------------------------------------------------

    @property
    def ready(self) -> bool:
        """Whether a read would not wait."""
        return bool(self._chunks)

    @property
    def available(self) -> int:
        """How many bytes can be read."""
        return sum(map(len, self._chunks))

    def wait(self, seconds: float | None) -> bool:
        """Wait for input, at most so many seconds, None for no limit; returns False if there is none."""
        universe = self._universe
        if self._chunks or (seconds is not None and seconds <= 0):
            universe.charge()
            return self.ready
        kernel = universe.kernel
        end = FOREVER if seconds is None else kernel.now + wait_ns(seconds)
        while not self._chunks:  # another thread may read it
            left = FOREVER if end == FOREVER else end - kernel.now
            if left == 0 or kernel.wait_on(self.waits, left) is TIMEOUT:
                break
        return self.ready

    def read(self, size: int) -> bytes:
        """`os.read`: at most `size` bytes, of one line in cooked mode; b"" at the end of the file.

        Raises:
            BlockingIOError: if no input is available and the file is non-blocking.
        """
        if not self._wait_to_read():
            return b""
        if self._attributes[LFLAG] & termios.ICANON:
            return self._cut(self._chunks.pop(0), size)
        everything = b"".join(self._chunks)
        self._chunks.clear()
        return self._cut(everything, size)

    def _cut(self, data: bytes, size: int) -> bytes:
        if len(data) > size:
            self._chunks.insert(0, data[size:])
        return data[:size]

    def _wait_to_read(self) -> bool:
        if not self.blocking and not self._chunks:
            self._universe.charge()
            raise BlockingIOError(11, "Resource temporarily unavailable")
        controls = self._attributes[CC]
        polled = not self._attributes[LFLAG] & termios.ICANON and _number(controls[termios.VMIN]) == 0
        return self.wait(_number(controls[termios.VTIME]) * _VTIME_S if polled else None)

    def put_back(self, data: bytes) -> None:
        """Put back bytes that were read before, so that the next read begins with them."""
        if data:
            self._chunks.insert(0, data)

    def flush(self) -> None:
        """`termios.tcflush`: discard typed input that has not been read."""
        self._chunks.clear()
        self._line.clear()

    def attributes(self) -> list[Any]:
        """`termios.tcgetattr`."""
        return [*self._attributes[:CC], list(self._attributes[CC])]

    def set_attributes(self, attributes: Sequence[Any]) -> None:
        """`termios.tcsetattr`. An unfinished line becomes readable when cooked mode ends."""
        if len(attributes) != CC + 1:
            raise TypeError("tcsetattr, arg 3: must be 7 element list")
        self._attributes = [*attributes[:CC], list(attributes[CC])]
        if self._line and not self._attributes[LFLAG] & termios.ICANON:
            self._end_line()
            self._universe.kernel.wake_all(self.waits)


def _number(control: Any) -> int:
    """Return VMIN or VTIME as a number; programs set them as bytes or as numbers."""
    return control if isinstance(control, int) else ord(control)


def terminal_of(universe: Universe, file: Any) -> Terminal:
    """Return the terminal of a file.

    Raises:
        termios.error: if the file is not a terminal.
    """
    number = descriptor(file)
    if universe.terminal is None or number not in _STANDARD:
        raise termios.error(*_NOT_A_TERMINAL)
    return universe.terminal


def termios_module(universe: Universe) -> ModuleType:
    """Return the module `termios` of a universe."""

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
    """Return the module `fcntl` of a universe: the host's for files, the terminal's settings for 0, 1 and 2."""

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
    """Return the terminal's answer to TIOCGWINSZ (its size) and FIONREAD (whether there is something to read)."""
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
