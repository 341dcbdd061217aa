"""`asyncio` on the kernel: the standard library's own, with an event loop that waits in virtual time.

The loop has timers, threads and executors; transports and servers need sockets, which are refused.
"""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING, Any

from cfepy.nodes.locks import wait_ns
from cfepy.rtos import FOREVER, WaitList

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe


class Wakeup:
    """What the loop waits on, in place of a selector: a timeout, or a call from another thread.

    Args:
        universe: whose loop it is.
    """

    def __init__(self, universe: Universe) -> None:
        self._universe = universe
        self._waits = WaitList(f"an event for asyncio in {universe.name}")
        self._set = False

    def set(self) -> None:
        """Let the loop go on."""
        if not self._universe.kernel.wake_first(self._waits):
            self._set = True

    def select(self, timeout: float | None) -> list[Any]:
        """Wait at most `timeout` seconds, None for ever; there are never any files that are ready."""
        if timeout is not None and timeout <= 0:
            self._universe.charge()
        elif not self._set:
            self._universe.kernel.wait_on(self._waits, FOREVER if timeout is None else wait_ns(timeout))
        self._set = False
        return []

    def close(self) -> None:
        """Nothing to give back."""


def fix_asyncio(universe: Universe, module: ModuleType) -> None:
    """After `asyncio` was loaded: its default event loop is one of the kernel's."""

    class KernelEventLoop(module.BaseEventLoop):  # type: ignore[misc, name-defined]  # the node's own copy
        def __init__(self) -> None:
            super().__init__()
            self._selector = Wakeup(universe)

        def _process_events(self, events: list[Any]) -> None:
            """There are no files, hence no events of any."""

        def _write_to_self(self) -> None:
            self._selector.set()

    class KernelEventLoopPolicy(module.events.BaseDefaultEventLoopPolicy):  # type: ignore[misc, name-defined]
        _loop_factory = KernelEventLoop

    vars(module).update(DefaultEventLoopPolicy=KernelEventLoopPolicy, SelectorEventLoop=KernelEventLoop)
    module.set_event_loop_policy(KernelEventLoopPolicy())
