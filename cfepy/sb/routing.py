"""The routing table of the Software Bus (CFE_SBR): the pipes of each MsgId, and the delivery counts.

The first subscription to a MsgId creates its route, which stays because it keeps the sequence count. Route ids count
from 1 in the order of creation. A dictionary replaces NASA's map, so there are no collisions.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from cfepy.interpreter.compiled import mypyc_attr
from cfepy.msg import MAX_SEQUENCE_COUNT
from cfepy.ports import Block
from cfepy.sb.pipe import Pipe

COMMAND = 0x1000  # bits of a MsgId: the packet type, and whether a secondary header follows
SECONDARY = 0x0800
GLOBAL = 0  # scope of a subscription: it is reported to other processors
LOCAL = 1
INVALID_ROUTE_ID = 0
INVALID_MSG_ID = 0

Totals = tuple[int, int, int, int]
"""Numbers of messages delivered, waiting, dropped for a message limit, dropped for a full pipe."""


class Destination:
    """A pipe on a route (CFE_SB_DestinationD_t); `puts - gets` is NASA's BuffCount.

    If a pipe was unsubscribed and subscribed again while messages waited in it, `kin` has all its destinations, the
    newest last. Otherwise it is None.
    """

    __slots__ = ("active", "block", "gets", "kin", "limit", "limit_drops", "overflow_drops", "pipe", "puts", "scope")

    def __init__(self, pipe: Pipe, limit: int, scope: int, block: Block | None = None) -> None:
        self.pipe = pipe
        self.limit = limit
        self.scope = scope
        self.block = block  # memory from the bus's pool
        self.active = True
        self.puts = self.gets = 0
        self.limit_drops = self.overflow_drops = 0
        self.kin: list[Destination] | None = None

    def counted_at(self) -> Destination:
        """Return the destination that counts a message of this destination when it leaves the pipe.

        It is the newest subscription with waiting messages. NASA's bus looks up the destination by MsgId, so a message
        of an older subscription makes room for a message of the newer one.
        """
        if self.kin is None:
            return self
        return next((each for each in reversed(self.kin) if each.puts > each.gets), self)


@mypyc_attr(allow_interpreted_subclasses=True)
class PutHook:
    """Called before each put into a pipe; this base class does nothing.

    Args:
        inner: the previous hook; None for none.
    """

    def __init__(self, inner: PutHook | None = None) -> None:
        self._inner = inner

    def limit(self, destination: Destination) -> int:
        """Return the message limit for the next put: the limit of the subscription, unless a hook changes it."""
        return destination.limit if self._inner is None else self._inner.limit(destination)

    def put(self, destination: Destination) -> None:
        """Handle a packet that the running task is about to put into a pipe, or to pass to a task that waits there."""
        if self._inner is not None:
            self._inner.put(destination)


class Route:
    """All destinations of one MsgId, the newest subscriber first; the route stays when the last one leaves.

    `active` is replaced and never modified, so a transmission in progress continues with its own tuple.
    """

    __slots__ = ("_past", "active", "destinations", "gone", "is_telemetry", "msg_id", "relayed", "route_id", "sequence")

    def __init__(self, msg_id: int, route_id: int) -> None:
        self.msg_id = msg_id
        self.route_id = route_id
        self.is_telemetry = msg_id & (COMMAND | SECONDARY) == SECONDARY
        self.sequence = 0  # number of messages numbered here; its low 14 bits are the last sequence count
        self.relayed = 0  # number of messages that came with their own sequence count
        self.destinations: list[Destination] = []
        self.active: tuple[Destination, ...] = ()
        self.gone: list[Destination] = []  # of ended subscriptions, until their counts are final
        self._past: Totals = (0, 0, 0, 0)  # of destinations that are no longer in the list

    @property
    def sent(self) -> int:
        """The number of messages transmitted on this route."""
        return self.sequence + self.relayed

    def find(self, pipe: Pipe) -> Destination | None:
        """Return the destination of a pipe, or None (CFE_SB_GetDestPtr)."""
        for destination in self.destinations:
            if destination.pipe is pipe:
                return destination
        return None

    def add(self, destination: Destination) -> None:
        """Add a destination at the front: the newest subscriber gets a message first (CFE_SB_AddDestNode)."""
        kin = [each for each in self.gone if each.pipe is destination.pipe and each.puts != each.gets]
        if kin:
            kin.append(destination)
            for each in kin:
                each.kin = kin
        self.destinations.insert(0, destination)
        self.refresh()

    def remove(self, destination: Destination) -> None:
        """Remove a destination (CFE_SB_RemoveDestNode)."""
        self.destinations.remove(destination)
        settled = [each for each in self.gone if each.puts == each.gets or each.pipe.is_closed()]
        self._past = _sum(self._past, settled)
        self.gone = [each for each in self.gone if each not in settled]
        self.gone.append(destination)  # a transmission in progress may still count here
        self.refresh()

    def refresh(self) -> None:
        """Renew `active` after a change."""
        self.active = tuple(destination for destination in self.destinations if destination.active)

    def totals(self) -> Totals:
        """Return the delivery counts of all present and past destinations."""
        return _sum(self._past, [*self.destinations, *self.gone])


def _sum(past: Totals, destinations: Iterable[Destination]) -> Totals:
    delivered, waiting, by_limit, by_pipe = past
    for each in destinations:
        delivered += each.gets
        waiting += each.puts - each.gets
        by_limit += each.limit_drops
        by_pipe += each.overflow_drops
    return delivered, waiting, by_limit, by_pipe


@dataclass(slots=True)
class Throttle:
    """The part of the table that `RoutingTable.for_each_route_id` handles at once (CFE_SBR_Throttle_t).

    `start` is the first index, `count` the maximum number of routes. `following` is an output: the index to continue
    with, or 0 at the end of the table.
    """

    start: int = 0
    count: int = 1
    following: int = 0


class RoutingTable:
    """The CFE_SBR_* functions. With unknown route ids they do nothing, or return an invalid id, 0 or an empty value, as
    NASA's functions do.

    Args:
        capacity: maximum number of routes (CFE_PLATFORM_SB_MAX_MSG_IDS).
        highest: largest valid MsgId.

    Attributes:
        routes: routes by MsgId, in the order of their ids. The bus reads it directly.
    """

    def __init__(self, capacity: int, highest: int) -> None:
        self._capacity = capacity
        self._highest = highest
        self.routes: dict[int, Route] = {}
        self._table: list[Route] = []

    def init(self) -> None:
        """Remove all routes (CFE_SBR_Init, CFE_SBR_Init_Map)."""
        self.routes.clear()
        self._table.clear()

    def add_route(self, msg_id: int) -> int:
        """Create the route of a MsgId without one (CFE_SBR_AddRoute, CFE_SBR_SetRouteId).

        Returns:
            Its id, or INVALID_ROUTE_ID for an invalid MsgId or a full table.
        """
        if not 0 < msg_id <= self._highest or len(self._table) >= self._capacity:
            return INVALID_ROUTE_ID
        route = Route(msg_id, self.value_to_route_id(len(self._table)))
        self._table.append(route)
        self.routes[msg_id] = route
        return route.route_id

    def get_route_id(self, msg_id: int) -> int:
        """Return the id of a MsgId's route, or INVALID_ROUTE_ID if it never had a subscriber (CFE_SBR_GetRouteId)."""
        route = self.routes.get(msg_id)
        return route.route_id if route is not None else INVALID_ROUTE_ID

    def route(self, route_id: int) -> Route | None:
        """Return the route of an id."""
        index = self.route_id_to_value(route_id)
        return self._table[index] if 0 <= index < len(self._table) else None

    def get_msg_id(self, route_id: int) -> int:
        """Return the MsgId of a route, or INVALID_MSG_ID if there is none (CFE_SBR_GetMsgId)."""
        route = self.route(route_id)
        return route.msg_id if route is not None else INVALID_MSG_ID

    def get_dest_list_head_ptr(self, route_id: int) -> list[Destination]:
        """Return the destinations of a route, newest first (CFE_SBR_GetDestListHeadPtr)."""
        route = self.route(route_id)
        return list(route.destinations) if route is not None else []

    def set_dest_list_head_ptr(self, route_id: int, destinations: list[Destination]) -> None:
        """Replace the destinations of a route (CFE_SBR_SetDestListHeadPtr)."""
        route = self.route(route_id)
        if route is not None:
            route.destinations[:] = destinations
            route.refresh()

    def increment_sequence_counter(self, route_id: int) -> None:
        """Count a message (CFE_SBR_IncrementSequenceCounter)."""
        route = self.route(route_id)
        if route is not None:
            route.sequence += 1

    def get_sequence_counter(self, route_id: int) -> int:
        """Return the sequence count of the last message that the bus numbered, 0 to 0x3FFF
        (CFE_SBR_GetSequenceCounter).
        """
        route = self.route(route_id)
        return route.sequence & MAX_SEQUENCE_COUNT if route is not None else 0

    def for_each_route_id(self, callback: Callable[[int], object], throttle: Throttle | None = None) -> None:
        """Call a function with the id of each route, in the order of creation (CFE_SBR_ForEachRouteId).

        Args:
            callback: called with each id.
            throttle: the part of the table; None for all.
        """
        start, end = 0, len(self._table)
        if throttle is not None:
            start = throttle.start
            throttle.following = 0
            if start + throttle.count < end:
                end = throttle.following = start + throttle.count
        for index in range(start, end):
            callback(self.value_to_route_id(index))

    def is_valid_route_id(self, route_id: int) -> bool:
        """Return whether the table can have a route with this id (CFE_SBR_IsValidRouteId)."""
        return 0 < route_id <= self._capacity

    @staticmethod
    def value_to_route_id(value: int) -> int:
        """Return the id of an index of the table (CFE_SBR_ValueToRouteId)."""
        return value + 1

    @staticmethod
    def route_id_to_value(route_id: int) -> int:
        """Return the index of a route in the table, from 0 (CFE_SBR_RouteIdToValue)."""
        return route_id - 1
