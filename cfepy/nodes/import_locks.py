"""A thread that imports a module which another thread is still executing waits for it, as in Python itself.

Two threads that wait for each other's modules would be stuck: the second one then gets the unfinished module.
"""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from cfepy.rtos import WaitList

if TYPE_CHECKING:
    from cfepy.rtos import Kernel, Task


class ImportLocks:
    """Who is executing which module.

    Args:
        kernel: whose tasks import.
    """

    def __init__(self, kernel: Kernel) -> None:
        self._kernel = kernel
        self._loading: dict[str, tuple[Task, WaitList]] = {}
        self._waiting: dict[Task, str] = {}

    @property
    def busy(self) -> bool:
        """Whether any module is being executed now."""
        return bool(self._loading)

    @contextmanager
    def loading(self, name: str) -> Iterator[None]:
        """The current task executes the module `name`."""
        waits = WaitList(f"the import of {name}")
        self._loading[name] = self._kernel.current, waits
        try:
            yield
        finally:
            del self._loading[name]
            self._kernel.wake_all(waits)

    def wait_for(self, name: str) -> None:
        """Wait until no other task is executing the module `name`."""
        current = self._kernel.current
        entry = self._loading.get(name)
        if entry is None or current is self._kernel.host or self._is_circular(entry[0]):
            return
        self._waiting[current] = name
        try:
            self._kernel.wait_on(entry[1])
        finally:
            del self._waiting[current]

    def _is_circular(self, loader: Task) -> bool:
        """Whether `loader` is, or waits for, the current task."""
        current: Task | None = loader
        while current is not None and current is not self._kernel.current:
            name = self._waiting.get(current)
            entry = self._loading.get(name) if name is not None else None
            current = entry[0] if entry is not None else None
        return current is not None
