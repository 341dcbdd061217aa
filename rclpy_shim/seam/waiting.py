"""`Waiting`: one place where the tasks of a program wait for a message in any of its pipes (rcl's wait set).

All pipes of a program share one `WaitList`. The bus hands a packet to a task that waits for a pipe; here it is a task
that waits for all pipes of the program. That task puts the packet into its pipe, and all waiting tasks look again. So
the bus needs no extra work, and a more urgent program runs as soon as its message is sent.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Protocol

from cfepy.rtos import TIMEOUT, WaitList
from rospy_shim.client.node import Node
from rospy_shim.types.transport import WHOLE, sequence_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from cfepy.rtos import Kernel
    from cfepy.sb import Pipe

LONGEST_NS = 500_000_000
"""A task looks at least so often whether the program is shut down."""
_NEVER = 1 << 62


class Waitable(Protocol):
    """An entity that may have work for its program.

    Attributes:
        due_ns: steady time in ns at which it has work; only timers have one.
    """

    due_ns: int

    def ready(self) -> bool:
        """Return True if it has work."""


class Bell:
    """Wakes one executor (its guard condition). A ring holds until the executor waits the next time.

    Args:
        waiting: the waiting tasks of the program.

    Attributes:
        rung: it was rung since the last wait.
        worked: a callback has begun or ended since the last wait.
    """

    __slots__ = ("_waiting", "rung", "worked")

    def __init__(self, waiting: Waiting) -> None:
        self._waiting = waiting
        self.rung = False
        self.worked = False

    def note_work(self) -> None:
        """Wake the executor because a callback has begun or ended. Only threads of its own wait meanwhile."""
        self.worked = True
        if self._waiting.tasks:
            self._waiting.look_again()

    def ring(self) -> None:
        """Wake the executor."""
        self.rung = True
        if self._waiting.tasks:
            self._waiting.look_again()


class Waiting:
    """The waiting tasks of one program.

    Args:
        kernel: the kernel of the simulated computer.
        bus: the Software Bus.
        name: name of the program in reports of deadlocks.

    Attributes:
        tasks: the waiting tasks.
        version: changes when the program has other entities, or other pipes.
    """

    def __init__(self, kernel: Kernel, bus: Any, name: str) -> None:
        self._kernel = kernel
        self._bus = bus
        self.tasks = WaitList(f"work for the executor of {name}")
        self.version = 0
        self.is_over: Callable[[], bool] = lambda: False

    def adopt(self, pipe: Pipe) -> None:
        """Let messages of a pipe wake the program's tasks."""
        pipe.waits = self.tasks
        self.note_change()

    def release(self, pipe: Pipe) -> None:
        """Give a pipe that is about to be deleted a wait list of its own again."""
        pipe.waits = WaitList(f"a message on pipe {pipe.name}")
        self.note_change()

    def note_change(self) -> None:
        """Note that the program has other entities or pipes now."""
        self.version += 1
        self.look_again()

    def bell(self) -> Bell:
        """Return a bell for an executor."""
        return Bell(self)

    def look_again(self) -> None:
        """Let all waiting tasks look at their entities and bells."""
        if self.tasks:
            self._kernel.wake_all(self.tasks, TIMEOUT)

    def wait(
        self, bell: Bell, entities: Sequence[Waitable], end_ns: int | None, version: int
    ) -> tuple[list[Waitable], bool]:
        """Wait for work.

        Args:
            bell: ends the wait when it has been rung.
            entities: entities whose work ends the wait.
            end_ns: latest end, in ns of the steady clock; None for no limit.
            version: the `version` that the entities belong to; another one ends the wait.

        Returns:
            The entities with work, in their order, and True if the end has come.
        """
        kernel = self._kernel
        while True:
            is_over = self.is_over()  # may take time, in which others run: before the look
            ready = [each for each in entities if each.ready()]
            is_late = end_ns is not None and kernel.now >= end_ns
            if ready or bell.rung or bell.worked or is_late or is_over or self.version != version:
                bell.rung = bell.worked = False
                return ready, is_late
            due = min([each.due_ns for each in entities], default=_NEVER)
            limit = min(due if end_ns is None or due < end_ns else end_ns, kernel.now + LONGEST_NS) - kernel.now
            item = kernel.wait_on(self.tasks, max(limit, 1))
            if item is not TIMEOUT and item is not None:
                self._keep(item)
                self.look_again()

    def _keep(self, item: Any) -> None:
        """Put a packet that the bus gave to a task into its pipe, where it has its place by its sequence count.

        Later packets may have come before the task ran, and the pipe may have earlier ones that no task looked at. A
        pipe that holds one more than its depth now loses its oldest message, as if the packet had never left it.
        """
        pipe: Pipe = item[1].pipe
        if pipe.is_closed():
            return
        if not pipe.items:
            self._bus.put_back(pipe, [item])
            return
        found = self._bus.set_aside(pipe)
        count = sequence_of(item[0])
        later = (index for index, (packet, _) in enumerate(found) if (sequence_of(packet) - count) & 0x3FFF < 0x2000)
        found.insert(next(later, len(found)), item)
        if len(found) > pipe.depth and pipe.keeps_newest and found[0][0][2] & WHOLE == WHOLE:
            self._bus.discard(pipe, [found.pop(0)])
        self._bus.put_back(pipe, found)


class WaitingNode(Node):
    """A participant of the graph whose tasks wait in one place; it takes the arguments of `Node`.

    Attributes:
        waiting: the waiting tasks, which the shutdown wakes.
    """

    def __init__(self, *args: Any, **options: Any) -> None:
        super().__init__(*args, **options)
        self.waiting = Waiting(self.kernel, self.cfe.sb, self.universe.name)
        self.waiting.is_over = self.life.is_shutdown
        self.steady_ns = lambda: self.kernel.now
        self.life.wait_lists.append(self.waiting.tasks)
