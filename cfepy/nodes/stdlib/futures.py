"""Futures of a node, from `concurrent.futures` and `asyncio`: they hash by a serial number instead of their address.

The standard library iterates over sets of futures and threads, in the order of their hashes. `asyncio` is the standard
library's own, with an event loop based on the node's `select` and `socket`. The loop waits in virtual time. Its
transports and servers have a network if the node's sockets have one.
"""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe


def hash_by_serial(universe: Universe, cls: Any) -> None:
    """Make the objects of one of the node's classes hash by a serial number, assigned at the first hash."""

    def serial_hash(self: Any) -> int:
        number = self.__dict__.get("_serial_hash")
        if number is None:
            universe.serial = number = universe.serial + 1
            self.__dict__["_serial_hash"] = number
        return int(number)

    cls.__hash__ = serial_hash


def fix_futures(universe: Universe, module: ModuleType) -> None:
    """Fix `concurrent.futures._base` after loading: `as_completed` and `wait` make sets of futures."""
    hash_by_serial(universe, module.Future)


def fix_asyncio(universe: Universe, module: ModuleType) -> None:
    """Fix `asyncio` after loading: its default event loop must not use the host's processes or signals."""

    class KernelEventLoop(module.selector_events.BaseSelectorEventLoop):  # type: ignore[misc, name-defined]
        """The loop of the node's own copy of asyncio.

        A loop in a daemon thread ends with its process, without a word. Here the garbage collector meets it later, when
        its sockets are closed.
        """

        def __del__(self, *options: Any) -> None:
            if not universe.is_ending:
                super().__del__(*options)

    class KernelEventLoopPolicy(module.events.BaseDefaultEventLoopPolicy):  # type: ignore[misc, name-defined]
        _loop_factory = KernelEventLoop

    hash_by_serial(universe, module.Future)  # `asyncio.wait` and `as_completed` make sets of them and of tasks
    vars(module).update(DefaultEventLoopPolicy=KernelEventLoopPolicy, SelectorEventLoop=KernelEventLoop)
    module.set_event_loop_policy(KernelEventLoopPolicy())
