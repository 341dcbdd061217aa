"""stdout and stderr of C code, and the functions that end it: abort(), exit().

Both streams go to the console of the mission. A report of an abort includes the last lines of stderr, in which
libstdc++ names an uncaught exception.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator, Mapping
from contextlib import contextmanager
from functools import partial
from typing import TYPE_CHECKING

from cfepy.extra.c.crashes import CFault
from cfepy.reading.texts import to_bytes

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

STDIN, STDOUT, STDERR = 3, 1, 2
"""Handles of a FILE, whose contents code never reads. There is nothing to read from stdin."""
EOF = -1
READS_ONE = ("getc", "fgetc", "getwc", "getc_unlocked")
SCANS = ("fscanf", "__isoc99_fscanf", "__isoc23_fscanf", "vfscanf", "__isoc99_vfscanf", "__isoc23_vfscanf")
SCANS_STDIN = ("scanf", "__isoc99_scanf", "__isoc23_scanf", "vscanf", "__isoc99_vscanf", "__isoc23_vscanf")
LAST_WORDS = 8
"""Lines of stderr in the report of an abort."""


class LineWriter:
    """A stream of text. Lines are shown when they are complete, separately for each application.

    Args:
        show: gets the name of an application and a line of it.
    """

    def __init__(self, show: Callable[[str, str], object]) -> None:
        self._show = show
        self._begun: dict[str, bytes] = {}

    def write(self, app: str, data: bytes) -> None:
        """Take printed data of an application."""
        *lines, rest = (self._begun.get(app, b"") + data).split(b"\n")
        self._begun[app] = rest
        for line in lines:
            self._show(app, line.decode("utf-8", "surrogateescape"))

    def finish(self, app: str) -> None:
        """Show the unfinished line of an application, if there is one."""
        if self._begun.get(app):
            self.write(app, b"\n")


class Streams:
    """The open streams, by their FILE handles.

    Args:
        show: gets lines.
        app: returns the name of the running application.
        nodes: names of ROS nodes, by the names of their applications: their lines begin with them.
    """

    def __init__(
        self, show: Callable[[str], object], app: Callable[[], str] = str, nodes: Mapping[str, str] | None = None
    ) -> None:
        self._last: list[str] = []
        self._show_line = show
        self._app = app
        self._nodes = nodes or {}
        self._ending = ""
        self._lines = {STDOUT: LineWriter(self._show), STDERR: LineWriter(self._show_error)}
        self.writers: dict[int, Callable[[bytes], object]] = {
            stream: partial(self._write_text, lines) for stream, lines in self._lines.items()
        }

    def _write_text(self, lines: LineWriter, data: bytes) -> None:
        lines.write(self._owner(), data)

    def _owner(self) -> str:
        """Return the owner of a line; empty for applications that are not ROS nodes and share the console."""
        app = self._ending or self._app()
        return app if app in self._nodes else ""

    def _show(self, app: str, line: str) -> None:
        self._show_line(f"[{self._nodes[app]}] {line}" if app else line)

    def _show_error(self, app: str, line: str) -> None:
        self._last = [*self._last[1 - LAST_WORDS :], line]
        self._show(app, line)

    def finish(self, app: str) -> None:
        """Show the unfinished lines of an application that ends, if it is a ROS node."""
        for lines in self._lines.values() if app in self._nodes else ():
            lines.finish(app)

    @contextmanager
    def ending(self, app: str) -> Iterator[None]:
        """Assign output in this context, such as from destructors, to an application whose task has ended."""
        self._ending = app
        try:
            yield
        finally:
            self._ending = ""
            self.finish(app)

    def write(self, stream: int, data: bytes) -> int:
        """Write to a stream. Returns the number of bytes written.

        Raises:
            CFault: there is no such stream.
        """
        writer = self.writers.get(stream)
        if writer is None:
            raise CFault(f"0x{stream:x} is not an open FILE")
        writer(data)
        return len(data)

    def abort(self) -> None:
        """End an application that calls abort().

        Raises:
            CFault: always.
        """
        last, self._last = self._last, []
        raise CFault(": ".join(("abort()", *(line.strip() for line in last))))


def declare(api: Declarations, c: CRuntime) -> None:
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

    def keep(*arguments: int) -> int:
        """Leave a stream as it is: a line is always shown when it is complete."""
        return 0

    def end(name: str, status: int) -> None:
        raise CFault(f"{name}({status}) was called, which would end cFE")

    _declare_input(api, c)
    for name, value in (("stdin", STDIN), ("stdout", STDOUT), ("stderr", STDERR)):
        api.data[name] = struct.pack("<Q", value)
    api.add("fputs", "Sp", put_text, EOF)
    for name in ("fputc", "putc", "fputc_unlocked", "putc_unlocked"):
        api.add(name, "ip", put_character)
    api.add("setvbuf", "ppiQ", keep)
    api.add("setbuf", "pp", keep)
    api.add("ferror", "p", keep)
    api.add("fwrite", "pQQp", write)
    api.add("fprintf", "pf", print_to)
    api.add("__fprintf_chk", "p-f", print_to)
    api.add("vfprintf", "pv", print_to)
    api.add("__vfprintf_chk", "p-v", print_to)
    api.add("vprintf", "v", lambda text: print_to(STDOUT, text))
    api.add("__vprintf_chk", "-v", lambda text: print_to(STDOUT, text))
    api.add("fflush", "p", lambda stream: 0)
    api.add("gettext", "p", lambda text: text)
    api.add("abort", "", streams.abort)
    for name in ("exit", "_exit", "_Exit", "quick_exit"):
        api.add(name, "i", partial(end, name))


def _declare_input(api: Declarations, c: CRuntime) -> None:
    """Add functions that read: stdin is at its end, and knows that after the first attempt."""
    ended: set[int] = set()
    given_back: dict[int, list[int]] = {}

    def at_end(stream: int) -> int:
        ended.add(stream)
        return EOF

    def read_one(stream: int) -> int:
        return given_back[stream].pop() if given_back.get(stream) else at_end(stream)

    def read_line(to: int, size: int, stream: int) -> int:
        line = bytearray()
        while len(line) < size - 1 and not line.endswith(b"\n") and given_back.get(stream):
            line.append(given_back[stream].pop())
        if len(line) < size - 1 and not line.endswith(b"\n"):
            at_end(stream)
        if not line:
            return 0
        c.memory.poke(to, bytes(line) + b"\0")
        return to

    def give_back(code: int, stream: int) -> int:
        if code == EOF:
            return EOF
        given_back.setdefault(stream, []).append(code & 0xFF)
        ended.discard(stream)
        return code & 0xFF

    for name in READS_ONE:
        api.add(name, "p", read_one)
    api.add("getchar", "", lambda: read_one(STDIN))
    api.add("fgets", "pip", read_line)
    api.add("__fgets_chk", "p-ip", read_line)
    api.add("ungetc", "ip", give_back)
    for name in SCANS:
        api.add(name, "p", at_end)
    for name in SCANS_STDIN:
        api.add(name, "", lambda: at_end(STDIN))
    api.add("feof", "p", lambda stream: stream in ended)
    api.add("clearerr", "p", ended.discard)
