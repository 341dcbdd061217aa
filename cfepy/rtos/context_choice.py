"""The default kind of tasks: greenlets if they are installed, otherwise threads.

Both give the same run, and greenlets switch faster. Threads are used if greenlets would take away something from the
caller. The report of the run gives the reason.
"""

from __future__ import annotations

import threading
from importlib import import_module
from typing import NamedTuple

AUTO, THREAD, GREENLET = "auto", "thread", "greenlet"

FOLLOWED = "coverage, a profiler or a debugger follows threads"
ELSEWHERE = "begun outside of Python's main thread"


class TaskKind(NamedTuple):
    """The kind of a run's tasks.

    Attributes:
        name: "thread" or "greenlet".
        why: why `AUTO` does not use installed greenlets; empty if it uses them.
    """

    name: str
    why: str = ""

    def __str__(self) -> str:
        return f"{self.name} tasks ({self.why})" if self.why else f"{self.name} tasks"


def task_kind(asked: str) -> TaskKind:
    """Return the kind of tasks for a run that starts in this thread.

    A tool that set `threading.settrace` keeps a stack for each thread, and greenlets would look like one thread. A run
    that starts outside the main thread may continue in another thread, as with `asyncio.to_thread`. Greenlets cannot
    change their thread.

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
    """Return whether the library greenlet is installed and can be loaded."""
    try:
        import_module("greenlet")
    except ImportError:
        return False
    return True
