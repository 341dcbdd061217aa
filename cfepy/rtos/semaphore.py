"""A counting semaphore, or with a maximum of one a binary one: the kernel object under OS_CountSem and OS_BinSem."""

from __future__ import annotations

from cfepy.rtos.kernel import Kernel
from cfepy.rtos.task import FOREVER, TIMEOUT
from cfepy.rtos.wait_list import WaitList


class Semaphore:
    """A count that tasks take from, waiting if it is 0.

    Args:
        kernel: the kernel of the tasks.
        initial: the count at the start.
        maximum: a give above this count is lost, as with a binary semaphore; None for no limit.
        name: name for reports.
    """

    __slots__ = ("count", "kernel", "maximum", "name", "waits")

    def __init__(self, kernel: Kernel, initial: int = 0, maximum: int | None = None, name: str = "semaphore") -> None:
        self.kernel = kernel
        self.count = initial
        self.maximum = maximum
        self.name = name
        self.waits = WaitList(f"semaphore {name}")

    def give(self) -> None:
        """Wake one waiter, or increment the count."""
        if self.waits:
            self.kernel.make_ready(self.waits.pop(0), True)
        elif self.maximum is None or self.count < self.maximum:
            self.count += 1

    def take(self, timeout_ns: int = FOREVER) -> bool:
        """Decrement the count, or wait until another task gives.

        Args:
            timeout_ns: longest time to wait; 0 does not wait, FOREVER (-1) has no limit.

        Returns:
            False if the timeout expired.
        """
        if self.count > 0:
            self.count -= 1
            return True
        if timeout_ns == 0:
            return False
        return self.kernel.wait_on(self.waits, timeout_ns) is not TIMEOUT

    def flush(self) -> None:
        """Wake all waiters without changing the count (OS_BinSemFlush)."""
        self.kernel.wake_all(self.waits, True)
