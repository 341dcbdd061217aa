"""What faults do at certain times: a task of priority 0, which there is only while something is to be done.

May import cfepy.rtos and cfepy.status.
"""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from heapq import heapify, heappop, heappush
from typing import Any

from cfepy.rtos import WaitList
from cfepy.status import CfeError

PRIORITY = 0
TASK_NAME = "FAULTS"


class Agenda:
    """Actions by virtual time; it goes on over resets of the processor.

    Args:
        kernel: the simulated computer's.
    """

    def __init__(self, kernel: Any) -> None:
        self._kernel = kernel
        self._entries: list[tuple[int, int, bool, Callable[[], object]]] = []
        self._serial = 0
        self._waits = WaitList("the next fault")
        self._is_running = self._is_up = False

    def add(self, when_ns: int, action: Callable[[], object], survives: bool = False) -> None:
        """Do something at a time, at once when that is over.

        Args:
            when_ns: virtual time.
            action: called without arguments in the task of the faults.
            survives: a reset of the processor before that time changes nothing; otherwise it is forgotten then.
        """
        self._serial += 1
        heappush(self._entries, (when_ns, self._serial, survives, action))
        if self._is_running:
            self._kernel.wake_first(self._waits)
        elif self._is_up:
            self._start()

    def power_up(self) -> None:
        """A processor was made: what belonged to the one before is forgotten, the rest goes on."""
        self._entries = [entry for entry in self._entries if entry[2]]
        heapify(self._entries)
        self._is_running, self._is_up = False, True
        if self._entries:
            self._start()

    def _start(self) -> None:
        self._is_running = True
        self._waits = WaitList("the next fault")
        self._kernel.spawn(TASK_NAME, self._serve, PRIORITY)

    def _serve(self) -> None:
        kernel = self._kernel
        kernel.current.owner = None
        while self._entries:
            when_ns = self._entries[0][0]
            if when_ns > kernel.now:
                kernel.wait_on(self._waits, when_ns - kernel.now)
            else:
                with suppress(CfeError):  # a late message that finds no room; the bus has reported it
                    heappop(self._entries)[3]()
        self._is_running = False
