"""Tasks of a node: child tasks of its cFE application, OSAL tasks for Python's threads.

ES lets only the main task of an application create child tasks (CFE_ES_CreateChildTask), and starts them 50 ms later. A
task that a thread or callback starts is therefore a plain OSAL task (OS_TaskCreate), which ES ends with the application
all the same.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from cfepy.rtos import Kernel, Task
from cfepy.status import OsalError

if TYPE_CHECKING:
    from cfepy.app import Cfe
    from cfepy.nodes import Universe
    from rospy_shim.client.node import Node

_LABEL = 8  # characters; OSAL's names have at most 19


class NodeTasks:
    """Starts tasks in the name of one application; made in its main task.

    Args:
        cfe: the handle of cFE's services.
        kernel: the kernel of the simulated computer.
        number: returns a number that no task of the mission has yet.

    Attributes:
        owner: the application, as found in `Task.owner`.
    """

    def __init__(self, cfe: Cfe, kernel: Kernel, number: Callable[[], int]) -> None:
        info = cfe.es.get_app_info(cfe.es.get_app_id())
        self._cfe = cfe
        self._kernel = kernel
        self._number = number
        self._app: str = info.name
        self._stack_size: int = info.stack_size
        self.priority: int = info.priority
        self._main = kernel.current
        self.owner = self._main.owner

    def name(self, label: str) -> str:
        """Return a name of at most 19 characters that is unique in the mission."""
        tail = label.rpartition("/")[2][:_LABEL]
        number = self._number()
        return f"{self._app[: 19 - len(tail) - len(str(number)) - 2]}.{tail}.{number}"

    def child(self, node: Node, name: str, body: Callable[[], None]) -> None:
        """Start a task for a pipe; both have the same name.

        On ROS the first message may come as soon as the subscriber is made, so ES's delay is not guaranteed to the
        node.
        """
        entry = _in_universe(node.universe, body)
        if self._kernel.current is not self._main:
            self._cfe.os.task_create(name, entry, self._stack_size, self.priority)
            return

        def child_entry() -> None:
            self._kernel.has_started()
            entry()
            self._cfe.es.exit_child_task()

        self._kernel.may_start_early(name)
        self._cfe.es.create_child_task(name, child_entry, self._stack_size, self.priority)

    def thread(self, label: str, entry: Callable[[], object], priority: int) -> Task:
        """Start a thread of the node's program.

        Raises:
            RuntimeError: OSAL has no task left; the text is Python's.
        """
        name = self.name(label)
        begun: list[Task] = []

        def first() -> None:
            begun.append(self._kernel.current)
            entry()

        try:
            self._cfe.os.task_create(name, first, self._stack_size, priority)
        except OsalError as error:
            raise RuntimeError(f"can't start new thread: {error}") from error
        # A task that has begun may have ended by now, and is no longer among the tasks.
        return begun[0] if begun else next(task for task in reversed(self._kernel.tasks) if task.name == name)

    def helper(self, node: Node, label: str, body: Callable[[], None]) -> Task:
        """Start a short task from outside the application; ES ends it with the application."""
        entry = _in_universe(node.universe, body)
        return self._kernel.spawn(self.name(label), entry, self.priority, owner=self.owner)


def _in_universe(universe: Universe, body: Callable[[], None]) -> Callable[[], None]:
    """Return a task's entry that makes it a thread of the node."""

    def entry() -> None:
        universe.adopt_current()
        try:
            body()
        except SystemExit:
            pass  # ends the thread, as in Python
        finally:
            universe.release_current()

    return entry
