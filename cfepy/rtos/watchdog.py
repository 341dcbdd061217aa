"""A watchdog for the host: it names a task that does not give up the CPU, with its stack.

The simulation cannot do that itself: while one task computes, nothing else runs. So a thread of the host looks on, in
wall-clock time; it only tells, and changes nothing in the run.
"""

from __future__ import annotations

import contextlib
import sys
import threading
from collections.abc import Callable, Iterator

from cfepy.rtos.kernel import Kernel

LOOK_S = 1.0


def to_stderr(text: str) -> None:
    """Where a report goes by default."""
    sys.stderr.write(text + "\n")


class StallWatch:
    """Watches a kernel, from the first `begin` to `end`.

    Args:
        kernel: the kernel to watch.
        limit_s: wall-clock seconds without a kernel call after which the running task is reported.
        report: gets the text.
    """

    def __init__(self, kernel: Kernel, limit_s: float = 10.0, report: Callable[[str], object] = to_stderr) -> None:
        self._kernel = kernel
        self._limit_s = limit_s
        self._report = report
        self._over = threading.Event()
        self._thread: threading.Thread | None = None
        self._host_ident = 0
        self._is_paused = False

    def begin(self) -> None:
        """The calling thread is about to run the kernel. Cheap after the first time: a run may come in many pieces."""
        self._host_ident = threading.get_ident()
        if self._thread is None:
            self._thread = threading.Thread(target=self._look_on, name="cfepy stall watch", daemon=True)
            self._thread.start()

    def end(self) -> None:
        """Look no more."""
        self._over.set()
        if self._thread is not None:
            self._thread.join()

    @contextlib.contextmanager
    def paused(self) -> Iterator[None]:
        """Somebody looks at a task with a debugger, which takes its time."""
        self._is_paused = True
        try:
            yield
        finally:
            self._is_paused = False

    def _look_on(self) -> None:
        interval = min(LOOK_S, self._limit_s / 4)
        seen, still = self._kernel.progress(), 0.0
        while not self._over.wait(interval):
            now = self._kernel.progress()
            still = still + interval if now == seen and not self._is_paused else 0.0
            seen = now
            if still >= self._limit_s and self._kernel.current is not self._kernel.host:
                self._tell()
                still = 0.0

    def _tell(self) -> None:
        task = self._kernel.current
        stack = "".join(self._kernel.context.stack_of_running(task, self._host_ident))
        self._report(
            f"cfepy: task {task.name} has not given up the CPU for {self._limit_s:g} s of wall time; "
            f"it is here:\n{stack}"
        )
