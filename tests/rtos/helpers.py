"""Common parts of kernel tests."""

from __future__ import annotations

import threading
from collections.abc import Callable

import pytest

from cfepy.rtos import watchdog
from cfepy.rtos.cpu_time import Spent
from cfepy.rtos.watchdog import GRACE_S

LOOK_S = 0.01  # between two looks of a watch with `Clocks`


class Log(list[str]):
    """Lines in the order in which tasks wrote them."""

    def __call__(self, text: str) -> None:
        self.append(text)

    def writer(self, text: str) -> Callable[[], None]:
        """Return a task's entry point that writes one line."""
        return lambda: self.append(text)


class Clocks:
    """Clocks of the host for a stall watch, controlled by a test: `watch.spent = Clocks(...)`.

    Args:
        monkeypatch: lets watches check often, so that the test ends soon.
        used: share of a CPU that the process uses.
        ready: share of the time in which it is ready while other programs use the CPU.
    """

    def __init__(self, monkeypatch: pytest.MonkeyPatch, used: float, ready: float) -> None:
        monkeypatch.setattr(watchdog, "SOON_S", LOOK_S)
        monkeypatch.setattr(watchdog, "LOOK_S", LOOK_S)
        self._used, self._ready, self._wall_s = used, ready, 0.0

    def __call__(self) -> Spent:
        """As `cfepy.rtos.watchdog.Expenses`: each time the wall clock has gone further than a look may count."""
        self._wall_s += 2 * LOOK_S
        return Spent(self._wall_s, self._used * self._wall_s, self._ready * self._wall_s)

    def wait_for_looks(self) -> None:
        """Do not go on before the watch has seen twice the wall time that a run which is wanted to end is given."""
        enough = self._wall_s + 2 * 2 * GRACE_S  # it looks at the clocks twice each time
        while self._wall_s < enough:
            threading.Event().wait(0.001)
