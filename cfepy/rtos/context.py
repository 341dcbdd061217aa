"""What a task runs on: the three operations that the kernel asks of a task context, and the choice between them.

A context gives each task `resume` (let it go on, from the outside) and `park` (called by the task itself when it gave
the CPU away; None when `resume` already switched). Real threads are the reference; greenlets are the fast alternative.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Protocol

from cfepy.rtos.task import Task


class Context(Protocol):
    """A way to run tasks."""

    name: str
    interrupts: tuple[type[BaseException], ...]  # come from outside the simulation: they end the run, not just a task

    def bind_host(self, host: Task) -> None:
        """Prepare the caller of `Kernel.run`, which takes part as a task of its own."""

    def create(self, task: Task, main: Callable[[Task], Task]) -> None:
        """Prepare a task: its first `resume` runs `main(task)`, which returns the task to resume at its end."""

    def prepare_run(self, tasks: list[Task]) -> None:
        """A run begins, on whatever CPU the host is now."""

    def enter(self, host: Task) -> None:
        """Wait in the host until the baton comes back; the kernel handed it out before."""

    def interrupt(self, running: Callable[[], Task], host: Task, error: type[BaseException]) -> None:
        """The host was woken by a signal while a task had the baton, `running()` at any moment.

        Wait for the baton, which comes at the task's next kernel call, and raise `error` in a task that makes none.
        """

    def stack_of_running(self, task: Task, host_ident: int) -> list[str]:
        """The formatted stack of the running task, seen from another OS thread; `host_ident` is the host's."""


def make_context(name: str) -> Context:
    """The context called `name`.

    Args:
        name: "thread" or "greenlet".

    Raises:
        ValueError: another name, or greenlet is not installed.
    """
    if name == "thread":
        from cfepy.rtos.threads import ThreadContext

        return ThreadContext()
    if name == "greenlet":
        from cfepy.rtos.greenlets import GreenletContext

        return GreenletContext()
    raise ValueError(f"no task context is called {name!r}; choose thread or greenlet")
