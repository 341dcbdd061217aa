"""A task of the simulated real-time system: plain data, changed by the kernel and by the objects that tasks
wait for.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from cfepy import trace

if TYPE_CHECKING:
    from cfepy.rtos.mutex import Mutex
    from cfepy.rtos.wait_list import WaitList


class TaskExit(BaseException):
    """Unwinds a task that ends or is killed. Only the kernel catches it."""


def is_end_of_task(error: BaseException | None) -> bool:
    """Return whether an error is a `TaskExit`, or was raised by code that ran while a task unwound.

    The task's `finally` and `except` clauses may raise an error, such as the release of a lock that a condition did not
    get back. On the target the task ends without running them.
    """
    while error is not None and not isinstance(error, TaskExit):
        error = error.__context__
    return error is not None


class Timeout:
    """The type of `TIMEOUT`, the result of a wait that timed out."""

    def __repr__(self) -> str:
        return "TIMEOUT"

    def __bool__(self) -> bool:
        return False


TIMEOUT = Timeout()
FOREVER = -1
PLACE = 1000
"""The amount that a preemption point adds to `Task.passed`."""


class Task:
    """One thread of control, with a priority from 0 (most urgent) to 255."""

    __slots__ = (
        "alias",
        "awaits",
        "base_priority",
        "carrier",
        "children",
        "cpu_ns",
        "done",
        "dying",
        "entry",
        "error",
        "exit_mark",
        "held",
        "ident",
        "interruption",
        "joiners",
        "killer",
        "mark",
        "mutex",
        "name",
        "number",
        "owner",
        "park",
        "passed",
        "path",
        "priority",
        "refusals",
        "resume",
        "since",
        "started",
        "timer",
        "waits",
        "wake",
        "wake_mark",
    )

    def __init__(self, name: str, ident: int, entry: Callable[[], object] | None, priority: int) -> None:
        self.name = name
        self.alias = name  # its name in schedules
        self.ident = ident
        self.entry = entry
        self.priority = self.base_priority = priority
        self.number = 0  # OSAL's id of the task, until the task has ended
        self.owner: Any = None  # the task's owner, such as an application of ES
        self.resume: Callable[[], Any] = _not_bound
        self.park: Callable[..., Any] | None = None
        self.interruption: BaseException | None = None  # exception to raise in the call that it waits in
        self.carrier: Any = None  # the OS thread or greenlet that runs it
        self.wake: Any = None  # the value that ended the last wait
        self.timer = 0  # number of the pending timer, 0 if there is none
        self.waits: WaitList | None = None
        self.awaits: WaitList | None = None  # the list in which it waits repeatedly, each time with a time limit
        self.since = 0  # virtual ns at which its last wait without a time limit began, or at which it ended
        self.mutex: Mutex | None = None  # the mutex it waits for
        self.joiners: WaitList | None = None  # the tasks that wait until it can be deleted
        self.held: list[Mutex] = []
        self.started = self.done = self.dying = False
        self.killer: Task | None = None
        self.error: BaseException | None = None
        self.refusals = 0
        self.cpu_ns = 0
        self.children = 0  # number of tasks that it has created
        self.passed = 0  # PLACE for each preemption point passed, 1 for each wait and for each task woken since
        self.path = ""  # its position in the tree of tasks, such as "3.1"; it does not depend on the schedule
        self.mark = trace.mark(trace.DISPATCH, ident)
        self.wake_mark = trace.mark(trace.WAKE, ident)
        self.exit_mark = trace.mark(trace.EXIT, ident)

    def __repr__(self) -> str:
        return f"<Task {self.ident} {self.name!r} priority {self.priority}>"


def _not_bound() -> None:
    raise RuntimeError("the task has no context yet")
