"""The waits of a mission that can never end, in any schedule from here on.

cfepy knows which tasks can end a wait. For locks these are their holders, and for service calls the tasks that work on
them. For OSAL's semaphores and condition variables they are the applications that created them or looked up their ids.
For objects that a node makes from Python's locks (conditions, events, queues, ends of threads), they are all tasks that
can still reach the lock (`cfepy.nodes.reachable_objects`), including callbacks for messages. A wait for a pipe, an OSAL
queue, a socket or a time can be ended from outside.
"""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field
from pathlib import PurePath
from types import FrameType, FunctionType
from typing import TYPE_CHECKING, NamedTuple

from cfepy.interpreter.own_code import is_own_code
from cfepy.osal import OsObject
from cfepy.rtos import Kernel, Task, Wait, circles, endless
from cfepy.units import NS_PER_MS, instant_text

if TYPE_CHECKING:
    from cfepy.mission.mission import Mission
    from rospy_shim.client.node import Node


LONG_NS = 100 * NS_PER_MS  # a wait before the end of a program counts from here on
_QUEUE = "queue"
_ENDED_BY = {
    "Queue.put": frozenset(["get", "get_nowait", "queue"]),
    "Queue.get": frozenset(["put", "put_nowait", "queue"]),
    "Queue.join": frozenset(["task_done", "unfinished_tasks"]),
}
"""Methods of `queue.Queue` that wait, and the names of those that can end the wait."""


class EndlessWait(NamedTuple):
    """A task that waits forever.

    Attributes:
        app: the application of the task.
        task: its name.
        what: the object that it waits for, such as `lock 3 of ARM` or `the end of Queue.get()`.
        place: the line of its own source, such as `arm.py:12`; empty if unknown.
        since_ns: virtual time at which it began to wait.
        holder: the task that holds the object, and whether that task has ended; empty if no task holds it.
    """

    app: str
    task: str
    what: str
    place: str
    since_ns: int
    holder: str = ""

    @property
    def text(self) -> str:
        """A one-line description."""
        where = f" at {self.place}" if self.place else ""
        why = f"held by {self.holder}" if self.holder else "no remaining task can end this wait"
        return f"{self.task} waits forever for {self.what}{where}, since {instant_text(self.since_ns)}; {why}"


class EndlessWaits(NamedTuple):
    """The waits of a mission that can never end.

    Attributes:
        circles: tasks that wait for each other, or a task that waits for an ended task.
        alone: tasks that no task is left to wake, if it matters: main tasks, and tasks that others wait for. An idle
            worker does not count. Tasks that only wait for one of the others are not listed.
    """

    circles: list[tuple[EndlessWait, ...]]
    alone: list[EndlessWait]


@dataclass
class WaitsAtEnds:
    """The waits of nodes, just before their programs ended with an error; a part of the mission's record.

    Attributes:
        by_app: by application; of several starts, the last one.
    """

    by_app: dict[str, EndlessWaits] = field(default_factory=dict)


def note_waits(mission: Mission, app: str) -> None:
    """Keep the waits of a node that can never end in the mission's record; see `Mission.on_bad_end`.

    A single wait counts only if it began some time ago: the program could have ended a later one if it had not ended
    itself.
    """
    found, before_ns = endless_waits(mission), mission.kernel.now - LONG_NS
    circles = [circle for circle in found.circles if any(wait.app == app for wait in circle)]
    alone = [wait for wait in found.alone if wait.app == app and wait.since_ns <= before_ns]
    mission.record.part(WaitsAtEnds).by_app[app] = EndlessWaits(circles, alone)


def endless_waits(mission: Mission) -> EndlessWaits:
    """Find the waits, while no task runs, or one whose program is over."""
    kernel = mission.kernel
    found = endless(kernel.tasks, _Wakers(mission).could_end)
    rings = [tuple(_told(kernel, wait) for wait in circle) for circle in circles(found)]
    awaited = {wait.holder for wait in found}
    alone = [wait for wait in found if wait.holder is None and (wait.task in awaited or _is_main(wait.task))]
    return EndlessWaits(rings, [_told(kernel, wait) for wait in alone])


def _is_main(task: Task) -> bool:
    return task.number != 0 and task.number == getattr(task.owner, "main_task_id", 0)


def _told(kernel: Kernel, wait: Wait) -> EndlessWait:
    task = wait.task
    place, call = _place(kernel.context.frame_of(task))
    gone = ", which has ended" if wait.holder is not None and wait.holder.done else ""
    holder = "" if wait.holder is None else wait.holder.name + gone
    owner = "" if task.owner is None else task.owner.name
    what = f"the end of {call}()" if call and wait.holder is None else wait.what
    return EndlessWait(owner, task.name, what, place, task.since, holder)


def _place(frame: FrameType | None) -> tuple[str, str]:
    """Return the innermost line of a task's own source, and the library function that it called there."""
    call = ""
    while frame is not None:
        file = frame.f_code.co_filename
        if is_own_code(file):
            return f"{PurePath(file).name}:{frame.f_lineno}", call
        if not frame.f_globals.get("__name__", "cfepy").startswith("cfepy"):
            call = frame.f_code.co_qualname
        frame = frame.f_back
    return "", ""


class _Wakers:
    """Determines which tasks could end the wait of a task."""

    def __init__(self, mission: Mission) -> None:
        self._mission = mission
        self._kernel = mission.kernel

    def could_end(self, task: Task, lost: Collection[Task]) -> bool:
        subject = None if task.waits is None or task.awaits is not None else task.waits.subject
        if subject is None or task.owner is None:
            return True
        if isinstance(subject, OsObject):
            return self._is_used(subject, lost)
        node = None if self._mission.ros is None else self._mission.ros.node_of(task.owner)
        return node is None or self._is_known(node, task, subject, lost)

    def _is_used(self, record: OsObject, lost: Collection[Task]) -> bool:
        """Return whether an application that knows the id of an object has a task that can continue, or a timer."""
        users = {record.owner, *record.users}
        has_timer = self._mission.cfe.os.has_timer
        return (
            None in users
            or any(has_timer(user) for user in users)
            or any(task.owner in users and task not in lost for task in self._kernel.tasks)
        )

    def _is_known(self, node: Node, task: Task, lock: object, lost: Collection[Task]) -> bool:
        """Return whether code that a node may still execute can reach a lock, or its main program waits there
        for good.
        """
        from cfepy.nodes import can_call, held_by, reaches

        roots: list[object] = [node, *node.universe.exit_hooks, *node.universe.signals.handlers()]
        frames = []
        for each in self._kernel.tasks:
            if each.owner is node.owner and each not in lost:
                frame = self._kernel.context.frame_of(each)
                roots += [each.entry, *held_by(frame)]
                frames += [] if frame is None else [frame]
        closed = [node.universe.importer.modules]
        enders = _enders(self._kernel.context.frame_of(task))
        is_reached = reaches(roots, lock, closed) and (not enders or can_call(roots, frames, enders, closed))
        return is_reached or (task is node.universe.main_task and self._is_at_rest(node, task, lock))

    def _is_at_rest(self, node: Node, task: Task, lock: object) -> bool:
        """Return whether a main program waits on an object that no other code can reach, that is, until Ctrl-C."""
        from cfepy.nodes import is_private

        own = self._kernel.context.frame_of(task)
        while own is not None and not is_own_code(own.f_code.co_filename):
            own = own.f_back
        return own is None or is_private(lock, own.f_code, _functions(node), [node.universe.importer.modules])


def _enders(frame: FrameType | None) -> frozenset[str]:
    """Return the names of the methods that can end a task's wait in a queue; empty for another wait."""
    while frame is not None and not is_own_code(frame.f_code.co_filename):
        if frame.f_globals.get("__name__") == _QUEUE and frame.f_code.co_qualname in _ENDED_BY:
            return _ENDED_BY[frame.f_code.co_qualname]
        frame = frame.f_back
    return frozenset()


def _functions(node: Node) -> list[object]:
    """Return the functions and classes of a node's own modules."""
    modules = node.universe.importer.modules.values()
    own = [module for module in modules if is_own_code(getattr(module, "__file__", None) or "<")]
    return [each for module in own for each in vars(module).values() if isinstance(each, (FunctionType, type))]
