"""The progress of long work, such as compiling: a line that changes on a terminal, finished lines in a test.

The work runs in the same way whether or not its progress is shown. A stream that is no terminal gets nothing, because
a program may compare the output of two runs.
"""

from __future__ import annotations

import contextlib
import shutil
import sys
from collections.abc import Callable, Iterator
from typing import TextIO

from cfepy.units import NS_PER_S
from cfepy.writing.escapes import raw, visible_line

LINE_EVERY_NS = 5 * NS_PER_S  # wall time between two finished lines
FIRST_NS = NS_PER_S // 2  # wall time before a terminal shows anything: short work needs no progress
TERMINAL_EVERY_NS = NS_PER_S // 10
ERASE_LINE = "\r\x1b[2K"

WriteLine = Callable[[str], object]
_line_writers: list[WriteLine] = []


@contextlib.contextmanager
def progress_lines(write: WriteLine) -> Iterator[None]:
    """Send the progress of all work to a function, as finished lines; a context manager.

    A test runner needs it, because it keeps standard error for itself.

    Args:
        write: receives a line without its end.
    """
    _line_writers.append(write)
    try:
        yield
    finally:
        _line_writers.remove(write)


class WorkProgress:
    """Shows the progress of one piece of work; a context manager around it.

    Args:
        elapsed_ns: wall time since the work began, in ns.
        stream: the output; None for the function of `progress_lines`, or standard error without one.
    """

    def __init__(self, elapsed_ns: Callable[[], int], stream: TextIO | None = None) -> None:
        self._elapsed_ns = elapsed_ns
        self._stream = raw(sys.stderr if stream is None else stream)
        self._write_line = _line_writers[-1] if _line_writers and stream is None else None
        self._is_seen = self._write_line is not None or self._stream.isatty()
        self._text = ""
        self._due_ns = FIRST_NS if self._write_line is None else LINE_EVERY_NS
        self._is_shown = False

    def __enter__(self) -> WorkProgress:
        return self

    def __exit__(self, *error: object) -> None:
        self.clear()

    def show(self, text: str) -> None:
        """Show the present state of the work if the last one is old enough.

        Args:
            text: a few words, such as `compiling 3 of 17: talker.cpp`.
        """
        self._text = text
        self.refresh()

    def refresh(self) -> None:
        """Show the last text again, with the time that has passed; call it from time to time during a long step."""
        if not self._is_seen or not self._text or (now := self._elapsed_ns()) < self._due_ns:
            return
        seconds = now // NS_PER_S
        line = visible_line(self._text) + (f" ({seconds} s so far)" if seconds else "")
        if self._write_line is not None:
            self._due_ns = now + LINE_EVERY_NS
            self._write_line(f"cfepy: {line}")
            return
        self._due_ns = now + TERMINAL_EVERY_NS
        self._is_shown = True
        self._write(ERASE_LINE + line[: shutil.get_terminal_size().columns - 1])

    def clear(self) -> None:
        """Remove the line from a terminal, at the end or before other output; the next `show` writes it again."""
        if self._is_shown:
            self._is_shown = False
            self._write(ERASE_LINE)

    def _write(self, text: str) -> None:
        with contextlib.suppress(OSError):  # a closed terminal ends no work
            self._stream.write(text)
            self._stream.flush()
