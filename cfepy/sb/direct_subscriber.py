"""`Outlet`: a subscriber that is not a task. It passes each packet on at once, so none waits and none is lost.

It represents a receiver outside of the simulated computer. The function that takes the packets may keep them or pass
them to the host. It must not wait or use the bus. An outlet is in no table of pipes, so it uses no queue of the board
and has no id for applications.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Any

from cfepy.sb.bus import SoftwareBus
from cfepy.sb.pipe import Pipe
from cfepy.sb.routing import LOCAL, Destination
from cfepy.status import CFE_SB_MAX_MSGS_MET, CfeError

NO_LIMIT = 0xFFFF


class Outlet(Pipe):
    """Passes on the packets of one MsgId until it is closed.

    Args:
        bus: the bus.
        msg_id: the MsgId.
        name: name for reports.
        take: called with each packet.

    Raises:
        CfeError: CFE_SB_MAX_MSGS_MET if the bus has no room for another MsgId.
    """

    __slots__ = ("_route",)

    def __init__(self, bus: SoftwareBus, msg_id: int, name: str, take: Callable[[bytes], object]) -> None:
        super().__init__(bus.kernel, NO_LIMIT, name, None)
        if msg_id not in bus.routes and not bus.routing.add_route(msg_id):
            raise CfeError(CFE_SB_MAX_MSGS_MET, f"the bus has no free entry for MsgId 0x{msg_id:04X}")
        self.items = _Passage(bus, take)
        self._route = bus.routes[msg_id]
        bus.outlets += 1
        self.pipe_id = -bus.outlets
        self._route.add(Destination(self, NO_LIMIT, LOCAL, None))

    def close(self, value: object = None) -> None:
        """Stop passing on packets."""
        destination = self._route.find(self)
        if destination is not None:
            self._route.remove(destination)
        self.depth = 0


class _Passage(deque[Any]):
    """The queue of an outlet: always empty."""

    def __init__(self, bus: SoftwareBus, take: Callable[[bytes], object]) -> None:
        super().__init__()
        self._bus = bus
        self._take = take

    def append(self, item: Any) -> None:
        """Pass on an incoming packet."""
        packet, destination = item
        self._bus.hand_on(packet, destination)
        self._take(packet)
