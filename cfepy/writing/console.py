"""The console of a mission: where OS_printf, the system log and the event port write their lines.

It keeps every line as it is, for tests and tools, and shows it on a stream, where control characters are escapes, or
hands it to a display.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TextIO

from cfepy.reading.texts import without_addresses
from cfepy.writing.escapes import console_line, raw


class Console:
    """Keeps and shows lines of text.

    Args:
        stream: where lines are shown; the standard output of the moment when None.
        quiet: keep the lines, show none.
        sink: a display that gets every line instead of the stream, quiet or not.

    Attributes:
        lines: everything written.
        record: gets every line too; a mission notes them in its trace.
    """

    __slots__ = ("lines", "quiet", "record", "sink", "stream")

    def __init__(
        self, stream: TextIO | None = None, quiet: bool = False, sink: Callable[[str], object] | None = None
    ) -> None:
        self.stream = stream
        self.quiet = quiet
        self.sink = sink
        self.lines: list[str] = []
        self.record: Callable[[str], object] | None = None

    def write(self, text: str) -> None:
        """Add text: one line, or several with newlines between them; a newline at the end adds no empty line."""
        for line in without_addresses(text).removesuffix("\n").split("\n"):
            self.lines.append(line)
            if self.record is not None:
                self.record(line)
            self._show(line)

    def show(self, line: str) -> None:
        """Show a line that is no part of the run, such as one that differs from run to run: it is not kept."""
        self._show(line)

    def _show(self, line: str) -> None:
        if self.sink is not None:
            self.sink(line)
        elif not self.quiet:
            stream = self.stream or sys.stdout
            raw(stream).write(console_line(line, colours=stream.isatty()) + "\n")
