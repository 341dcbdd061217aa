"""`sys.stdout`, `sys.stderr` and `sys.stdin` of a node: lines for the console, and a keyboard nobody types on."""

from __future__ import annotations

import io
from collections.abc import Callable


class ConsoleStream(io.TextIOBase):
    """Text that goes to the console line by line.

    Args:
        name: "<stdout>" or "<stderr>".
        fd: 1 or 2.
        write_line: takes each complete line, without its end.
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
        """The program has ended: show what it began to write."""
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


class NoInput(io.StringIO):
    """A standard input that is at its end."""

    name = "<stdin>"
    mode = "r"

    def fileno(self) -> int:
        return 0
