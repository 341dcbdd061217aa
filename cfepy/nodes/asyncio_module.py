"""`asyncio` on the kernel: the standard library's own, with an event loop on the node's own `select` and `socket`.

It waits in virtual time. Its transports and servers have a network when the node's sockets have one.
"""

from __future__ import annotations

from types import ModuleType
from typing import TYPE_CHECKING

from cfepy.nodes.serials import hash_by_serial

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe


def fix_asyncio(universe: Universe, module: ModuleType) -> None:
    """After `asyncio` was loaded: its default event loop asks the host for neither processes nor signals."""

    class KernelEventLoop(module.selector_events.BaseSelectorEventLoop):  # type: ignore[misc, name-defined]
        """The loop of the node's own copy of asyncio."""

    class KernelEventLoopPolicy(module.events.BaseDefaultEventLoopPolicy):  # type: ignore[misc, name-defined]
        _loop_factory = KernelEventLoop

    hash_by_serial(universe, module.Future)  # `asyncio.wait` and `as_completed` make sets of them, and of tasks
    vars(module).update(DefaultEventLoopPolicy=KernelEventLoopPolicy, SelectorEventLoop=KernelEventLoop)
    module.set_event_loop_policy(KernelEventLoopPolicy())
