"""Which kind of tasks a run gets that names none: greenlets where they are installed, else threads.

Both make the same run, so it is a matter of speed alone: greenlets are quicker to switch. Threads remain where
greenlets would take something away from the caller; why, the report of the run says.
"""

from __future__ import annotations

import threading
from importlib import import_module
from typing import NamedTuple

AUTO, THREAD, GREENLET = "auto", "thread", "greenlet"

FOLLOWED = "coverage, a profiler or a debugger follows threads"
ELSEWHERE = "begun outside of Python's main thread"


class TaskKind(NamedTuple):
    """What the tasks of a run are.

    Attributes:
        name: "thread" or "greenlet".
        why: why `AUTO` leaves installed greenlets alone; empty when it does not.
    """

    name: str
    why: str = ""

    def __str__(self) -> str:
        return f"{self.name} tasks ({self.why})" if self.why else f"{self.name} tasks"


def task_kind(asked: str) -> TaskKind:
    """The kind of tasks for a run that begins here and now.

    A tool that `threading.settrace` has told to follow all threads keeps a stack for each of them, and greenlets would
    look like one. A run that begins in another thread than the main one may be meant to go on in yet another, as with
    `asyncio.to_thread`; greenlets stay in theirs.

    Args:
        asked: "thread", "greenlet" or "auto".
    """
    if asked != AUTO:
        return TaskKind(asked)
    if not has_greenlets():
        return TaskKind(THREAD)
    if threading.gettrace() is not None or threading.getprofile() is not None:
        return TaskKind(THREAD, FOLLOWED)
    if threading.current_thread() is not threading.main_thread():
        return TaskKind(THREAD, ELSEWHERE)
    return TaskKind(GREENLET)


def has_greenlets() -> bool:
    """Whether the library greenlet is installed, and can be loaded."""
    try:
        import_module("greenlet")
    except ImportError:
        return False
    return True
