"""A bounded message queue between tasks: the kernel object under OS_Queue and under a Software Bus pipe."""

from __future__ import annotations

from collections import deque
from typing import Any, SupportsIndex

from cfepy.interpreter.compiled import mypyc_attr
from cfepy.rtos.kernel import Kernel
from cfepy.rtos.task import FOREVER, TIMEOUT
from cfepy.rtos.wait_list import WaitList


class Empty:
    """The type of `EMPTY`, the result of polling an empty queue."""

    def __repr__(self) -> str:
        return "EMPTY"

    def __bool__(self) -> bool:
        return False


EMPTY = Empty()


@mypyc_attr(allow_interpreted_subclasses=True)
class Queue:
    """A first-in, first-out queue of at most `depth` items; a waiting reader gets an item directly from the writer.

    Args:
        kernel: the kernel of the tasks.
        depth: maximum number of waiting items.
        name: name for reports.
    """

    __slots__ = ("depth", "items", "kernel", "name", "peak", "waits")

    def __init__(self, kernel: Kernel, depth: int, name: str = "queue") -> None:
        self.kernel = kernel
        self.depth = depth
        self.name = name
        self.items: deque[Any] = deque()
        self.waits = WaitList(f"queue {name}")
        self.peak = 0

    def put(self, item: Any) -> bool:
        """Add an item without waiting.

        Returns:
            False if the queue is full.
        """
        waits = self.waits
        if waits:
            if not self.peak:
                self.peak = 1
            self.kernel.make_ready(waits.pop(0), item)
            return True
        items = self.items
        if len(items) >= self.depth:
            return False
        items.append(item)
        if len(items) > self.peak:
            self.peak = len(items)
        return True

    def get(self, timeout_ns: SupportsIndex = FOREVER) -> Any:
        """Take the oldest item.

        Args:
            timeout_ns: longest time to wait; 0 polls, FOREVER (-1) waits without limit.

        Returns:
            The item, EMPTY from a poll, or TIMEOUT.
        """
        if self.items:
            return self.items.popleft()
        if timeout_ns == 0:
            return EMPTY
        return self.kernel.wait_on(self.waits, timeout_ns)

    def close(self, value: Any = TIMEOUT) -> None:
        """Close the queue: every waiting task gets `value`."""
        self.items.clear()
        self.kernel.wake_all(self.waits, value)

    def abandon(self) -> None:
        """Close the queue, and leave its waiting tasks where they are."""
        self.items.clear()
        self.waits.orphan()
