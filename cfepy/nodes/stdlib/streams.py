"""`sys.stdout`, `sys.stderr` and `sys.stdin` of a node: lines for the console, and typed keys, if any."""

from __future__ import annotations

import codecs
import io
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cfepy.nodes.stdlib.terminal import Terminal

STDIN = 0
ROWS, COLUMNS = 24, 80  # of a terminal
_PIECE = 4096  # bytes, longer than any line of a terminal


def descriptor(file: Any) -> int:
    """Return the number of a file, given as a number or an object with `fileno`."""
    number: int = file if isinstance(file, int) else file.fileno()
    return number


class ConsoleStream(io.TextIOBase):
    """Text output to the console, line by line.

    Args:
        name: "<stdout>" or "<stderr>".
        fd: 1 or 2.
        write_line: receives each complete line, without its line end.
    """

    encoding = "utf-8"
    errors = "replace"

    def __init__(self, name: str, fd: int, write_line: Callable[[str], object]) -> None:
        super().__init__()
        self.name = name
        self.mode = "w"
        self._fd = fd
        self._write_line = write_line
        self._begun = ""
        self.buffer = _Bytes(self)

    def writable(self) -> bool:
        return True

    def fileno(self) -> int:
        return self._fd

    def write(self, text: str) -> int:
        """Show the lines that `text` completes."""
        if not isinstance(text, str):
            raise TypeError(f"write() argument must be str, not {type(text).__name__}")
        if "\n" not in text:
            self._begun += text
            return len(text)
        *lines, rest = (self._begun + text).split("\n")
        self._begun = rest
        for line in lines:
            self._write_line(line)
        return len(text)

    def finish(self) -> None:
        """Show the unfinished line at the end of the program."""
        if self._begun:
            begun, self._begun = self._begun, ""
            self._write_line(begun)


class _Bytes(io.BufferedIOBase):
    """`sys.stdout.buffer`."""

    def __init__(self, text: ConsoleStream) -> None:
        super().__init__()
        self._text = text

    def writable(self) -> bool:
        return True

    def write(self, data: object) -> int:
        raw = bytes(data)  # type: ignore[call-overload]  # any buffer, as the interface of BufferedIOBase has it
        self._text.write(raw.decode("utf-8", "replace"))
        return len(raw)


class NoInput(io.TextIOWrapper):
    """A standard input at its end."""

    name = "<stdin>"
    mode = "r"

    def __init__(self) -> None:
        super().__init__(io.BytesIO(), encoding="utf-8")

    def fileno(self) -> int:
        return 0


class TypedInput(io.TextIOBase):
    """A standard input that is a terminal. It does not read ahead, so `select` is right.

    Args:
        terminal: provides the keys.
    """

    name = "<stdin>"
    mode = "r"
    encoding = "utf-8"
    errors = "strict"

    def __init__(self, terminal: Terminal) -> None:
        super().__init__()
        self._terminal = terminal
        self._decoder = codecs.getincrementaldecoder("utf-8")("replace")
        self.buffer = _TypedBytes(terminal)

    def __repr__(self) -> str:
        return "<_io.TextIOWrapper name='<stdin>' mode='r' encoding='utf-8'>"

    def readable(self) -> bool:
        return True

    def isatty(self) -> bool:
        return True

    def fileno(self) -> int:
        return STDIN

    def read(self, size: int | None = -1) -> str:
        """Wait for `size` characters, or all if no size is given; the end of the file returns fewer."""
        wanted = -1 if size is None else size
        return self._read_while(lambda text: wanted < 0 or len(text) < wanted)

    def readline(self, size: int | None = -1) -> str:  # type: ignore[override]  # typeshed wants a positional one
        """Wait for a line."""
        wanted = -1 if size is None else size
        return self._read_while(lambda text: not text.endswith("\n") and (wanted < 0 or len(text) < wanted))

    def _read_while(self, goes_on: Callable[[str], bool]) -> str:
        text = ""
        while goes_on(text):
            byte = self._terminal.read(1)
            if not byte:
                break
            text += self._decoder.decode(byte).replace("\r", "\n")
        return text


class _TypedBytes(io.BufferedIOBase):
    """`sys.stdin.buffer` of a terminal, and its raw file."""

    def __init__(self, terminal: Terminal) -> None:
        super().__init__()
        self._terminal = terminal

    @property
    def raw(self) -> _TypedBytes:
        return self

    def readable(self) -> bool:
        return True

    def isatty(self) -> bool:
        return True

    def fileno(self) -> int:
        return STDIN

    def read(self, size: int | None = -1) -> bytes:
        data = b""
        while size is None or size < 0 or len(data) < size:
            more = self._terminal.read(_PIECE if size is None or size < 0 else size - len(data))
            if not more:
                break
            data += more
        return data

    def read1(self, size: int = -1) -> bytes:
        return self._terminal.read(_PIECE if size < 0 else size)
