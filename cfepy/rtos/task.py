"""A task of the simulated real-time system, and the lists in which tasks wait.

Plain data, changed by the kernel and by the objects that tasks wait for.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from cfepy import trace

if TYPE_CHECKING:
    from cfepy.rtos.mutex import Mutex


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


class WaitList(list["Task"]):
    """Tasks that wait for one thing, most urgent first, first come first within a priority.

    Args:
        what: the thing, for the deadlock report: "queue HK_PIPE".

    Attributes:
        holders: the tasks that all have to let go of it before a wait can end; none where any task may end it.
        subject: the object by which a wait is ended, such as a lock of Python's; None where that is not known.
    """

    __slots__ = ("holders", "subject", "what")

    def __init__(self, what: str) -> None:
        super().__init__()
        self.what = what
        self.holders: Callable[[], Sequence[Task]] = tuple
        self.subject: object = None

    __hash__ = object.__hash__  # type: ignore[assignment]  # a place to wait has an identity


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
