"""stdout and stderr of C code, and what ends it: abort(), exit().

Both streams go to the console of the mission. What was written to stderr last is told when the code aborts: there
libstdc++ says which exception nobody caught.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import TYPE_CHECKING

from cfepy.c.api.text import Printer
from cfepy.c.faults import CFault
from cfepy.texts import to_bytes

if TYPE_CHECKING:
    from cfepy.c.calls import Declarations
    from cfepy.c.runtime import CRuntime

STDIN, STDOUT, STDERR = 3, 1, 2
"""What stands for a FILE: nobody looks into one. There is nothing to read from stdin."""
EOF = -1
UNREADABLE = ("getc", "getwc")
LAST_WORDS = 8
"""Lines of stderr that an abort tells."""


class Streams:
    """The streams that are open, by what stands for a FILE.

    Args:
        show: gets lines.
    """

    def __init__(self, show: Callable[[str], object]) -> None:
        self._last: list[str] = []
        self._show = show
        self.writers: dict[int, Callable[[bytes], object]] = {
            STDOUT: _writer(Printer(show)),
            STDERR: _writer(Printer(self._show_error)),
        }

    def _show_error(self, line: str) -> None:
        self._last = [*self._last[1 - LAST_WORDS :], line]
        self._show(line)

    def write(self, stream: int, data: bytes) -> int:
        """Write to a stream; the bytes that were written.

        Raises:
            CFault: there is no such stream.
        """
        writer = self.writers.get(stream)
        if writer is None:
            raise CFault(f"0x{stream:x} is no open FILE")
        writer(data)
        return len(data)

    def abort(self) -> None:
        """The end of an application that says so itself.

        Raises:
            CFault: always.
        """
        last, self._last = self._last, []
        raise CFault(": ".join(("abort()", *(line.strip() for line in last))))


def _writer(printer: Printer) -> Callable[[bytes], object]:
    return lambda data: printer.write(data.decode("utf-8", "surrogateescape"))


def declare(api: Declarations, c: CRuntime) -> None:
    """Add the functions; see `cfepy.c.api`."""
    memory, streams = c.memory, c.streams

    def put_text(text: str, stream: int) -> int:
        return streams.write(stream, to_bytes(text))

    def put_character(code: int, stream: int) -> int:
        streams.write(stream, bytes([code & 0xFF]))
        return code & 0xFF

    def write(data: int, size: int, count: int, stream: int) -> int:
        streams.write(stream, memory.peek(data, size * count))
        return count

    def print_to(stream: int, text: str) -> int:
        return streams.write(stream, to_bytes(text))

    def end(status: int) -> None:
        raise CFault(f"exit({status}) was called, which would end the whole of cFE")

    for name in UNREADABLE:
        api.add(name, "p", lambda stream: EOF)
    for name, value in (("stdin", STDIN), ("stdout", STDOUT), ("stderr", STDERR)):
        api.data[name] = struct.pack("<Q", value)
    api.add("fputs", "Sp", put_text, EOF)
    api.add("fputc", "ip", put_character)
    api.add("putc", "ip", put_character)
    api.add("fwrite", "pQQp", write)
    api.add("fprintf", "pf", print_to)
    api.add("__fprintf_chk", "p-f", print_to)
    api.add("vfprintf", "pv", print_to)
    api.add("__vfprintf_chk", "p-v", print_to)
    api.add("vprintf", "v", lambda text: print_to(STDOUT, text))
    api.add("fflush", "p", lambda stream: 0)
    api.add("gettext", "p", lambda text: text)
    api.add("abort", "", streams.abort)
    api.add("exit", "i", end)
