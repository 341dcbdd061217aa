"""Tasks on greenlets: the fast context behind `pip install cfepy[fast]`, six times cheaper to switch than threads.

The trace of a run is the same on both. What differs is the host's view: one OS thread, so `faulthandler` shows the
running task only, and thread-bound C libraries see a single thread.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy.rtos.task import Task

try:
    from greenlet import GreenletExit, getcurrent, greenlet
except ImportError as missing:
    raise ValueError("greenlet tasks need the library greenlet: pip install 'cfepy[fast]'") from missing


class GreenletContext:
    """One greenlet a task.

    Every greenlet is first entered from one shallow "starter": entered from each other, they would nest their C
    stacks and end in a RecursionError at about a thousand tasks.
    """

    name = "greenlet"
    interrupts: tuple[type[BaseException], ...] = (KeyboardInterrupt, GreenletExit)

    def __init__(self) -> None:
        self._starter = greenlet(_start_all)

    def bind_host(self, host: Task) -> None:
        here = getcurrent()
        host.carrier, host.resume, host.park = here, here.switch, None

    def create(self, task: Task, main: Callable[[Task], Task]) -> None:
        creator = getcurrent()

        def run() -> None:
            creator.switch()
            getcurrent().parent = main(task).carrier

        carrier = greenlet(run, parent=self._starter)
        task.carrier, task.resume, task.park = carrier, carrier.switch, None
        self._starter.switch(carrier)

    def prepare_run(self, tasks: list[Task]) -> None:
        pass

    def enter(self, host: Task) -> None:
        pass

    def interrupt(self, running: Callable[[], Task], host: Task, error: type[BaseException]) -> None:
        """Nothing to do: a signal is raised in the running task itself, which is on the host's own thread."""

    def stack_of_running(self, task: Task, host_ident: int) -> list[str]:
        from cfepy.rtos.threads import stack_of_thread

        return stack_of_thread(host_ident)


def _start_all(first: Any) -> None:
    pending = first
    while True:
        pending = pending.switch()
