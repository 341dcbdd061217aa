"""Applications that hang or are slow: the kernel's calls, as those of their tasks find them.

The methods of one kernel object are wrapped, and only in a run whose plan asks for it. Imports cfepy.rtos only.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from cfepy.rtos import FOREVER, WaitList

CALLS = ("wait_on", "delay", "yield_cpu", "charge")


class Strain:
    """What the kernel's calls do to some applications.

    Args:
        kernel: whose calls are wrapped.
    """

    def __init__(self, kernel: Any) -> None:
        self._kernel = kernel
        self._wait_on: Callable[..., Any] = kernel.wait_on
        self._charge: Callable[[int], None] = kernel.charge
        self._hanging: dict[int, tuple[Any, int | None]] = {}  # by identity: the application, and when it goes on
        self.burdens: list[Callable[[str, int], int]] = []
        for name in CALLS:
            setattr(kernel, name, self._wrapped(getattr(kernel, name), name == "charge"))

    def hang(self, app: Any, until_ns: int | None) -> None:
        """No task of an application comes back from its next call before a time; None is never."""
        self._hanging[id(app)] = app, until_ns

    def _wrapped(self, original: Callable[..., Any], is_charge: bool) -> Callable[..., Any]:
        """One of the kernel's methods, with what it costs before and whether it returns after."""

        def call(*args: Any) -> Any:
            kernel = self._kernel
            task = kernel.current
            owner = task.owner
            if owner is None or task.dying:
                return original(*args)
            more_ns = sum(burden(owner.name, args[0] if is_charge else 0) for burden in self.burdens)
            if more_ns:
                self._charge(more_ns)
            result = original(*args)
            if self._hanging and not task.dying:
                self._hold(task)
            return result

        return call

    def _hold(self, task: Any) -> None:
        """Keep the calling task as long as its application hangs."""
        held = self._hanging.get(id(task.owner))
        if held is None:
            return
        until_ns = held[1]
        if until_ns is None:
            self._wait_on(WaitList("the end of a fault: its application hangs"), FOREVER)
        elif until_ns > self._kernel.now:
            self._wait_on(WaitList("the end of a fault: its application hangs"), until_ns - self._kernel.now)
