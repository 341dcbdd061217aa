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
    """The standard streams for output, by their FILE handles.

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
        self._writers: dict[int, Callable[[bytes], object]] = {
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
        writer = self._writers.get(stream)
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
    streams = c.streams

    def print_to_console(text: str) -> int:
        return streams.write(STDOUT, to_bytes(text))

    def end(name: str, status: int) -> None:
        raise CFault(f"{name}({status}) was called, which would end cFE")

    for name, value in (("stdin", STDIN), ("stdout", STDOUT), ("stderr", STDERR)):
        api.data[name] = struct.pack("<Q", value)
    api.add("vprintf", "v", print_to_console)
    api.add("__vprintf_chk", "-v", print_to_console)
    api.add("gettext", "p", lambda text: text)
    api.add("abort", "", streams.abort)
    for name in ("exit", "_exit", "_Exit", "quick_exit"):
        api.add(name, "i", partial(end, name))
