"""Tracebacks that nodes print: exceptions that nobody handled, in the program, in a thread or in a callback.

What kills one thread of a node, or is swallowed by rospy after a callback, shows nowhere else. May import
cfepy.mission.
"""

from __future__ import annotations

import re
from pathlib import PurePath

from cfepy.explore.verdict import RAISED, Failure
from cfepy.mission.determinism_look import is_library, is_shown

_LINE = re.compile(r"\[(?P<node>[^\]\s]+)\] ?(?P<text>.*)")
_FRAME = re.compile(r'\s+File "(?P<file>.+)", line (?P<line>\d+)')
_BEGIN = "Traceback (most recent call last):"
_CHAINED = ("During handling of the above exception", "The above exception was the direct cause")


class _Reading:
    """The traceback that a node is printing."""

    def __init__(self) -> None:
        self.lines = [_BEGIN]
        self.place = ""


class TracebackReader:
    """Reads the console of a mission.

    Attributes:
        found: a failure for each traceback so far; of a chain of exceptions, the last.
    """

    def __init__(self) -> None:
        self.found: list[Failure] = []
        self._reading: dict[str, _Reading] = {}

    def take(self, line: str, now_ns: int, task: str = "") -> None:
        """Take a line of the console, the virtual time at which it was written, and the task that wrote it."""
        match = _LINE.fullmatch(line)
        if match is None:
            return
        node, text = match["node"], match["text"]
        if text.endswith(_BEGIN):
            self._reading[node] = _Reading()
        elif node in self._reading:
            self._go_on(node, text, now_ns, task)
        elif text.startswith(_CHAINED):
            self._forget_last(node)

    def _go_on(self, node: str, text: str, now_ns: int, task: str) -> None:
        reading = self._reading[node]
        reading.lines.append(text)
        frame = _FRAME.match(text)
        if frame is not None and reading.place and (is_library(frame["file"]) or not is_shown(frame["file"])):
            return
        if frame is not None:
            reading.place = f"{PurePath(frame['file']).name}:{frame['line']}"
        elif not text.startswith(" "):
            del self._reading[node]
            what = f"{text} ({reading.place})" if reading.place else text
            self.found.append(Failure(RAISED, node, what, now_ns, "\n".join(reading.lines), task))

    def _forget_last(self, node: str) -> None:
        """What was raised last was handled, or so somebody meant: what follows is the error."""
        mine = [at for at, failure in enumerate(self.found) if failure.who == node]
        if mine:
            del self.found[mine[-1]]
