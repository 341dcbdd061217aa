"""The console of a mission: the output of OS_printf, the system log and the event port.

It keeps every line unchanged for tests and tools. It also prints each line on a stream, with control characters
escaped, or passes it to a display.
"""

from __future__ import annotations

import sys
from collections.abc import Callable
from typing import TextIO

from cfepy.reading.texts import without_addresses
from cfepy.writing.escapes import console_line, raw


class Console:
    """Keeps and prints lines of text.

    Args:
        stream: the stream for the lines; None means the current standard output.
        quiet: keep the lines but print none.
        sink: a display that gets every line instead of the stream, even with `quiet`.

    Attributes:
        lines: all lines written so far.
        record: also called with every line; a mission notes them in its trace.
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
        """Add text of one or several lines; a newline at the end adds no empty line."""
        for line in without_addresses(text).removesuffix("\n").split("\n"):
            self.lines.append(line)
            if self.record is not None:
                self.record(line)
            self._show(line)

    def show(self, line: str) -> None:
        """Print a line that does not belong to the run, such as one that differs from run to run. The line is
        not kept.
        """
        self._show(line)

    def _show(self, line: str) -> None:
        if self.sink is not None:
            self.sink(line)
        elif not self.quiet:
            stream = self.stream or sys.stdout
            raw(stream).write(console_line(line, colours=stream.isatty()) + "\n")
