"""The watchdog of a board (CFE_PSP_Watchdog*): it resets the processor if no task serves it in time.

NASA's Linux PSP only keeps the value. On a board with a watchdog it counts virtual time and calls `on_bite`, which
resets the processor. On other boards it only keeps the value, as on Linux.
"""

from __future__ import annotations

from collections.abc import Callable

from cfepy.rtos import Kernel, WaitList
from cfepy.units import NS_PER_MS

WATCHDOG_MIN = 0
WATCHDOG_MAX = 0xFFFFFFFF
WATCHDOG_PRIORITY = 0


class Watchdog:
    """A counter that runs down while it is enabled.

    Args:
        kernel: the clock.
        on_bite: called in a task of priority 0 when the time has expired; None for no effect.
        longest_ms: longest time that it can count, in ms.
    """

    def __init__(
        self, kernel: Kernel, on_bite: Callable[[], object] | None = None, longest_ms: int = WATCHDOG_MAX
    ) -> None:
        self.kernel = kernel
        self.on_bite = on_bite
        self.longest_ms = longest_ms
        self.value_ms = longest_ms
        self.enabled = False
        self.bites = 0
        self._deadline = 0
        self._waits = WaitList("watchdog")
        self._watching = False

    def init(self) -> None:
        """Set the longest time and stop counting (CFE_PSP_WatchdogInit)."""
        self.value_ms = self.longest_ms
        self.enabled = False

    def enable(self) -> None:
        """Start counting (CFE_PSP_WatchdogEnable)."""
        self.enabled = True
        self.service()
        if self.on_bite is None:
            return
        if self._watching:
            self.kernel.wake_first(self._waits)
        else:
            self._watching = True
            self.kernel.spawn("PSP_WATCHDOG", self._watch, WATCHDOG_PRIORITY)

    def disable(self) -> None:
        """Stop counting (CFE_PSP_WatchdogDisable)."""
        self.enabled = False

    def service(self) -> None:
        """Restart the count (CFE_PSP_WatchdogService); this wakes no task."""
        self._deadline = self.kernel.now + self.value_ms * NS_PER_MS

    def set(self, value_ms: int) -> None:
        """Change the time in ms, at most to the longest time, and restart the count (CFE_PSP_WatchdogSet)."""
        self.value_ms = min(value_ms, self.longest_ms)
        self.service()
        if self._watching:
            self.kernel.wake_first(self._waits)

    def _watch(self) -> None:
        kernel = self.kernel
        kernel.current.owner = None
        while True:
            if not self.enabled:
                kernel.wait_on(self._waits)
            elif self._deadline > kernel.now:
                kernel.wait_on(self._waits, self._deadline - kernel.now)
            else:
                self.enabled = False
                self.bites += 1
                assert self.on_bite is not None
                self.on_bite()
