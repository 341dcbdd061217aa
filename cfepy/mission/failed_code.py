"""Failures in the mission's own code: exceptions from tasks, and tracebacks on the console.

An error that ends one thread of a node, or that rospy swallows after a callback, appears only as a traceback that the
node prints. A `TracebackReader` finds it on the console.
"""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from pathlib import PurePath
from typing import NamedTuple

from cfepy.interpreter.own_code import is_own_code
from cfepy.rtos import DeadlockError, InjectedCrash, Task, TaskExit

_LINE = re.compile(r"\[(?P<node>[^\]\s]+)\] ?(?P<text>.*)")
_FRAME = re.compile(r'\s+File "(?P<file>.+)", line (?P<line>\d+)')
_PLACE_AT_END = re.compile(r"\([^\s()]+:\d+\)$")
_BEGIN = "Traceback (most recent call last):"
_ASKED_TO_END = "KeyboardInterrupt"  # Ctrl-C, which ends nodes and is not an error
_END_OF_TASK = f"{TaskExit.__module__}.{TaskExit.__name__}"  # printed by code that runs while its task unwinds
_CHAINED = ("During handling of the above exception", "The above exception was the direct cause")


class RaisedError(NamedTuple):
    """An exception from a task, or one whose traceback a node printed.

    Attributes:
        who: the application, or the node that printed it.
        text: type, text and place in one line: `ValueError: no such joint (arm.py:12)`.
        at_ns: virtual time in ns.
        detail: the traceback.
        task: the task that raised it.
        cause: identifies the exception by its type and place, `ValueError (arm.py:12)`; empty without a place.
        circle: for a mutex that was refused to prevent a deadlock: the waits of the tasks, as text.
        circle_apps: the applications of these tasks.
    """

    who: str
    text: str
    at_ns: int
    detail: str
    task: str
    cause: str = ""
    circle: str = ""
    circle_apps: tuple[str, ...] = ()


def raised_in(task: Task, error: BaseException, at_ns: int) -> RaisedError:
    """Return the record of an exception from a task of an application."""
    from cfepy.mission.tracebacks import app_traceback, reason

    detail, text = app_traceback(error), reason(error)
    if isinstance(error, DeadlockError) and error.circle:
        where = detail.partition(f"\n{type(error).__module__}")[0]
        apps = tuple(dict.fromkeys(wait.task.owner.name for wait in error.circle if wait.task.owner is not None))
        circle = "; ".join(map(str, error.circle))
        return RaisedError(task.owner.name, text, at_ns, where, task.name, circle=circle, circle_apps=apps)
    return RaisedError(task.owner.name, text, at_ns, detail, task.name, cause_of(type(error).__name__, text))


def cause_of(kind: str, text: str) -> str:
    """Return the type of an exception and the line that raised it, which identify it: `KeyError (arm.py:12)`."""
    place = _PLACE_AT_END.search(text)
    return f"{kind} {place[0]}" if place is not None else ""


class _Reading:
    """The traceback that a node is printing."""

    def __init__(self) -> None:
        self.lines = [_BEGIN]
        self.place = ""


class TracebackReader:
    """Reads the console of a mission.

    Attributes:
        found: an error for each traceback so far; for a chain of exceptions, the last one.
    """

    def __init__(self) -> None:
        self.found: list[RaisedError] = []
        self._reading: dict[str, _Reading] = {}
        self._last_end: dict[str, str] = {}  # by node: why its last traceback is not an error; empty if it is one
        self._unwinding: set[str] = set()  # nodes whose next traceback is chained to the end of a task

    def take(self, line: str, now_ns: int, task: str = "") -> None:
        """Read a line of the console, with the virtual time and the task that wrote it."""
        if line[:1] != "[":
            return
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
        if frame is not None and reading.place and not is_own_code(frame["file"]):
            return
        if frame is not None:
            reading.place = f"{PurePath(frame['file']).name}:{frame['line']}"
        elif not text.startswith(" "):
            del self._reading[node]
            last_end = self._last_end[node] = self._end_of(node, text)
            if last_end:
                return
            what = f"{text} ({reading.place})" if reading.place else text
            cause = cause_of(text.partition(":")[0], what)
            self.found.append(RaisedError(node, what, now_ns, "\n".join(reading.lines), task, cause))

    def _end_of(self, node: str, text: str) -> str:
        """Return why a traceback is not an error: its task ends, or Ctrl-C; empty if it is an error."""
        if node in self._unwinding or text.startswith(_END_OF_TASK):
            self._unwinding.discard(node)
            return _END_OF_TASK
        return _ASKED_TO_END if text.startswith(_ASKED_TO_END) else ""

    def _forget_last(self, node: str) -> None:
        """Drop the previous exception, because its handler raised the next one, which is the error.

        If the previous one was the end of the task, the next one is not an error either.
        """
        last_end = self._last_end.get(node, "")
        if last_end == _END_OF_TASK:
            self._unwinding.add(node)
        if last_end:
            return
        mine = [at for at, error in enumerate(self.found) if error.who == node]
        if mine:
            del self.found[mine[-1]]


@dataclass(slots=True)
class FailedCode:
    """The failures of a run; a part of its record.

    Attributes:
        died: exceptions from tasks of applications, except crashes injected by a fault plan.
        crashed: applications that a fault plan crashed.
        printed: reads the tracebacks that nodes print.
    """

    died: list[RaisedError] = field(default_factory=list)
    crashed: set[str] = field(default_factory=set)
    printed: TracebackReader = field(default_factory=TracebackReader)

    def take(self, task: Task, error: BaseException, at_ns: int) -> None:
        """Record an exception from a task."""
        if task.owner is None:
            return
        if isinstance(error, InjectedCrash):
            self.crashed.add(task.owner.name)
        else:
            self.died.append(raised_in(task, error, at_ns))
