"""`Waiting`: one place where the tasks of a program wait for a message in any of its pipes (rcl's wait set).

All pipes of a program share one `WaitList`. The bus hands a packet to a task that waits for a pipe; here it is a task
that waits for all pipes of the program. That task puts the packet into its pipe, and all waiting tasks look again. So
the bus needs no extra work, and a more urgent program runs as soon as its message is sent.
"""

from __future__ import annotations

from collections.abc import Iterable
from typing import TYPE_CHECKING, Any, Protocol

from cfepy.rtos import FOREVER, TIMEOUT, WaitList
from rospy_shim.client.node import Node
from rospy_shim.types.transport import WHOLE, sequence_of

if TYPE_CHECKING:
    from cfepy.rtos import Kernel
    from cfepy.sb import Pipe

LONGEST_NS = 500_000_000
"""A task looks at least so often whether the program is shut down."""


class Waitable(Protocol):
    """An entity that may have work for its program."""

    def ready(self) -> bool:
        """Return True if it has work."""


class Waiting:
    """The waiting tasks of one program.

    Args:
        kernel: the kernel of the simulated computer.
        bus: the Software Bus.
        name: name of the program in reports of deadlocks.

    Attributes:
        tasks: the waiting tasks.
        rings: number of calls of `ring` so far.
    """

    def __init__(self, kernel: Kernel, bus: Any, name: str) -> None:
        self._kernel = kernel
        self._bus = bus
        self.tasks = WaitList(f"work for the executor of {name}")
        self.rings = 0

    def adopt(self, pipe: Pipe) -> None:
        """Let messages of a pipe wake the program's tasks."""
        pipe.waits = self.tasks

    def release(self, pipe: Pipe) -> None:
        """Give a pipe that is about to be deleted a wait list of its own again."""
        pipe.waits = WaitList(f"a message on pipe {pipe.name}")

    def ring(self) -> None:
        """Wake all waiting tasks; a task that is about to wait does not."""
        self.rings += 1
        if self.tasks:
            self._kernel.wake_all(self.tasks, TIMEOUT)

    def wait(self, seen: int, waitables: Iterable[Waitable], timeout_ns: int | None) -> None:
        """Wait for work.

        Args:
            seen: value of `rings` when the caller began to look for work.
            waitables: entities whose work ends the wait.
            timeout_ns: longest time in ns; None for no limit.
        """
        if self.rings != seen or any(each.ready() for each in waitables):
            return
        if timeout_ns is not None and timeout_ns <= 0:
            return
        limit = FOREVER if timeout_ns is None else timeout_ns
        item = self._kernel.wait_on(self.tasks, min(limit, LONGEST_NS) if limit != FOREVER else LONGEST_NS)
        if item is not TIMEOUT and item is not None:
            self._keep(item)
            if self.tasks:
                self._kernel.wake_all(self.tasks, TIMEOUT)

    def _keep(self, item: Any) -> None:
        """Put a packet that the bus gave to a task into its pipe, where it has its place by its sequence count.

        Later packets may have come before the task ran, and the pipe may have earlier ones that no task looked at. A
        pipe that holds one more than its depth now loses its oldest message, as if the packet had never left it.
        """
        pipe: Pipe = item[1].pipe
        if pipe.is_closed():
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
        self.life.wait_lists.append(self.waiting.tasks)
