"""A task of the simulated real-time system: plain data, changed by the kernel and by what tasks wait for."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from cfepy import trace

if TYPE_CHECKING:
    from cfepy.rtos.mutex import Mutex
    from cfepy.rtos.wait_list import WaitList


class TaskExit(BaseException):
    """Unwinds a task that ends or is killed. Only the kernel catches it."""


class Timeout:
    """The type of `TIMEOUT`, the value a wait gives when its time is over."""

    def __repr__(self) -> str:
        return "TIMEOUT"

    def __bool__(self) -> bool:
        return False


TIMEOUT = Timeout()
FOREVER = -1
PLACE = 1000
"""What a place where others could get in adds to `Task.passed`."""


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
        self.alias = name  # what schedules call it
        self.ident = ident
        self.entry = entry
        self.priority = self.base_priority = priority
        self.number = 0  # OSAL's id of the task, known until the task has ended
        self.owner: Any = None  # what the task works for: an application of ES
        self.resume: Callable[[], Any] = _not_bound
        self.park: Callable[..., Any] | None = None
        self.interruption: BaseException | None = None  # comes out of the call that it waits in
        self.carrier: Any = None  # what the context runs it on: an OS thread or a greenlet
        self.wake: Any = None  # the value that ended the last wait
        self.timer = 0  # number of the pending timer, 0 when there is none
        self.waits: WaitList | None = None
        self.awaits: WaitList | None = None  # what it waits for again and again, with a limit to each wait
        self.since = 0  # virtual ns at which its last wait without a limit in time began
        self.mutex: Mutex | None = None  # the mutex it waits for
        self.held: list[Mutex] = []
        self.started = self.done = self.dying = False
        self.killer: Task | None = None
        self.error: BaseException | None = None
        self.refusals = 0
        self.cpu_ns = 0
        self.children = 0  # tasks that it has made
        self.passed = 0  # PLACE for each place where others could get in, 1 for each wait and task woken since
        self.path = ""  # which child of which task it is, such as "3.1": the same whoever runs when
        self.mark = trace.mark(trace.DISPATCH, ident)
        self.wake_mark = trace.mark(trace.WAKE, ident)
        self.exit_mark = trace.mark(trace.EXIT, ident)

    def __repr__(self) -> str:
        return f"<Task {self.ident} {self.name!r} priority {self.priority}>"


def _not_bound() -> None:
    raise RuntimeError("the task has no context yet")
