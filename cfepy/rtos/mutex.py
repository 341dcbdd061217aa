"""A recursive mutex with transitive priority inheritance: the kernel object under OS_MutSem."""

from __future__ import annotations

from cfepy.rtos.errors import DeadlockError
from cfepy.rtos.kernel import Kernel
from cfepy.rtos.task import Task
from cfepy.rtos.wait_graph import Wait
from cfepy.rtos.wait_list import WaitList


class Mutex:
    """A mutex for one task at a time; its owner gets the priority of the most urgent waiter.

    Args:
        kernel: the kernel of the tasks.
        name: name for reports.
        stays_locked: whether it stays locked if its owner ends, as a mutex of Linux's threads does; otherwise the first
            waiter gets it. A task that waits for a mutex that stays locked cannot be ended by another one either.
    """

    __slots__ = ("count", "kernel", "name", "owner", "stays_locked", "waits")

    def __init__(self, kernel: Kernel, name: str = "mutex", stays_locked: bool = False) -> None:
        self.kernel = kernel
        self.name = name
        self.stays_locked = stays_locked
        self.owner: Task | None = None
        self.count = 0
        self.waits = WaitList(f"mutex {name}")
        self.waits.is_cancelable = not stays_locked
        self.waits.holders = lambda: () if self.owner is None else (self.owner,)

    def take(self) -> None:
        """Wait until the mutex is free or belongs to the caller.

        Raises:
            DeadlockError: if the owner waits, directly or through others, for a mutex of the caller. A mutex that stays
                locked does not tell: its tasks wait forever.
        """
        kernel = self.kernel
        task = kernel.current
        if self.owner is None:
            self.owner, self.count = task, 1
            task.held.append(self)
        elif self.owner is task:
            self.count += 1
        else:
            self._wait(task)

    def give(self) -> bool:
        """Free the mutex, or undo one of several takes.

        Returns:
            False if the caller does not own the mutex.
        """
        kernel = self.kernel
        task = kernel.current
        if self.owner is not task:
            return False
        self.count -= 1
        if self.count:
            return True
        if self.waits:
            self.abandon(task)
            kernel.preempt()
        else:
            task.held.remove(self)
            self.owner = None
        return True

    def abandon(self, owner: Task) -> None:
        """Take the mutex from its owner and give it to the first waiter, without running the waiter yet."""
        kernel = self.kernel
        owner.held.remove(self)
        self.owner, self.count = None, 0
        if self.waits:
            heir = self.waits.pop(0)
            self.owner, self.count = heir, 1
            heir.held.append(self)
            heir.mutex = None
            kernel.enqueue(heir, None)
            kernel.inherit(heir)
            if heir.joiners is not None:
                kernel.call_joiners(heir)
        kernel.inherit(owner)

    def _wait(self, task: Task) -> None:
        kernel = self.kernel
        circle = () if self.stays_locked else self._circle(task)
        if circle:
            text = f"{task.name} takes mutex {self.name}, whose owner waits for {task.name}:\n{kernel.waiting()}"
            raise DeadlockError(text, circle)
        task.mutex = self
        owner, priority = self.owner, task.priority
        while owner is not None and owner.priority > priority and not owner.done:
            kernel.reprioritize(owner, priority)
            owner = owner.mutex.owner if owner.mutex is not None else None
        try:
            kernel.wait_on(self.waits)
        finally:
            task.mutex = None
            if self.owner is not None and self.owner is not task:
                kernel.inherit(self.owner)  # the waiter was killed, so its priority no longer counts

    def _circle(self, task: Task) -> tuple[Wait, ...]:
        """Return the cycle of tasks that would arise if this task waited here, the oldest task first; empty if there is
        none.
        """
        waits: list[Wait] = []
        waiter = task
        mutex: Mutex | None = self
        while mutex is not None and mutex.owner is not None:
            waits.append(Wait(waiter, mutex.waits.what, mutex.owner))
            waiter, mutex = mutex.owner, mutex.owner.mutex
            if waiter is task:
                oldest = waits.index(min(waits, key=lambda wait: wait.task.ident))
                return (*waits[oldest:], *waits[:oldest])
        return ()
