"""The routing table of the Software Bus (CFE_SBR): which pipes a MsgId goes to, and the fate of each message.

A route is made by the first subscription to a MsgId and stays for good, since it keeps the sequence count. Route ids
count from 1 in the order in which routes were made; a dictionary stands for NASA's map, so nothing collides.
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
GLOBAL = 0  # scope of a subscription: other processors are told of it
LOCAL = 1
INVALID_ROUTE_ID = 0
INVALID_MSG_ID = 0

Totals = tuple[int, int, int, int]
"""Messages delivered, waiting, dropped for a message limit, dropped for a full pipe."""


class Destination:
    """One pipe on a route (CFE_SB_DestinationD_t); `puts - gets` is NASA's BuffCount.

    `kin` has the destinations of a pipe that was unsubscribed and subscribed again while messages waited in it, the
    newest last; None for all others.
    """

    __slots__ = ("active", "block", "gets", "kin", "limit", "limit_drops", "overflow_drops", "pipe", "puts", "scope")

    def __init__(self, pipe: Pipe, limit: int, scope: int, block: Block | None = None) -> None:
        self.pipe = pipe
        self.limit = limit
        self.scope = scope
        self.block = block  # of the bus's memory pool
        self.active = True
        self.puts = self.gets = 0
        self.limit_drops = self.overflow_drops = 0
        self.kin: list[Destination] | None = None

    def counted_at(self) -> Destination:
        """Where a message of this destination counts when it leaves the pipe.

        That is the newest subscription, as long as something of it waits: NASA's bus looks the destination up by the
        message's id, so a message that came under an older subscription makes room for one of the newer.
        """
        if self.kin is None:
            return self
        return next((each for each in reversed(self.kin) if each.puts > each.gets), self)


@mypyc_attr(allow_interpreted_subclasses=True)
class PutHook:
    """Stands before each put into a pipe; one that does nothing is the base of those that do.

    Args:
        inner: the hook that was there before; None for none.
    """

    def __init__(self, inner: PutHook | None = None) -> None:
        self._inner = inner

    def limit(self, destination: Destination) -> int:
        """The message limit for the put that comes: that of the subscription, unless a hook says another."""
        return destination.limit if self._inner is None else self._inner.limit(destination)

    def put(self, destination: Destination) -> None:
        """The running task is about to put its packet into the pipe, or to hand it to a task that waits there."""
        if self._inner is not None:
            self._inner.put(destination)


class Route:
    """All destinations of one MsgId, the newest subscriber first; it stays when the last one leaves.

    `active` is replaced and never changed: a transmission that is under way goes on with the tuple it began with.
    """

    __slots__ = ("_past", "active", "destinations", "gone", "is_telemetry", "msg_id", "relayed", "route_id", "sequence")

    def __init__(self, msg_id: int, route_id: int) -> None:
        self.msg_id = msg_id
        self.route_id = route_id
        self.is_telemetry = msg_id & (COMMAND | SECONDARY) == SECONDARY
        self.sequence = 0  # messages that were given a sequence count here; its low 14 bits are the last such count
        self.relayed = 0  # messages that came with their own
        self.destinations: list[Destination] = []
        self.active: tuple[Destination, ...] = ()
        self.gone: list[Destination] = []  # of subscriptions that ended, until nothing can change their counts
        self._past: Totals = (0, 0, 0, 0)  # of those that are not in the list any more

    @property
    def sent(self) -> int:
        """Messages transmitted on this route."""
        return self.sequence + self.relayed

    def find(self, pipe: Pipe) -> Destination | None:
        """The destination that a pipe is, or None (CFE_SB_GetDestPtr)."""
        for destination in self.destinations:
            if destination.pipe is pipe:
                return destination
        return None

    def add(self, destination: Destination) -> None:
        """Put a destination in front: the newest subscriber gets a message first (CFE_SB_AddDestNode)."""
        kin = [each for each in self.gone if each.pipe is destination.pipe and each.puts != each.gets]
        if kin:
            kin.append(destination)
            for each in kin:
                each.kin = kin
        self.destinations.insert(0, destination)
        self.refresh()

    def remove(self, destination: Destination) -> None:
        """Take a destination off (CFE_SB_RemoveDestNode)."""
        self.destinations.remove(destination)
        settled = [each for each in self.gone if each.puts == each.gets or each.pipe.is_closed()]
        self._past = _sum(self._past, settled)
        self.gone = [each for each in self.gone if each not in settled]
        self.gone.append(destination)  # a transmission that is under way may still count here
        self.refresh()

    def refresh(self) -> None:
        """Make `active` new after a change."""
        self.active = tuple(destination for destination in self.destinations if destination.active)

    def totals(self) -> Totals:
        """What became of the messages, over all destinations that there ever were."""
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
    """How much of the table `RoutingTable.for_each_route_id` does at once (CFE_SBR_Throttle_t).

    `start` is the index to begin with, `count` the largest number of routes. `following` is an output: the index to go
    on with, 0 at the end of the table.
    """

    start: int = 0
    count: int = 1
    following: int = 0


class RoutingTable:
    """The CFE_SBR_* functions. Unknown route ids do nothing or give an invalid id, 0 or nothing, as NASA's do.

    Args:
        capacity: most routes there can be (CFE_PLATFORM_SB_MAX_MSG_IDS).
        highest: largest valid MsgId.

    Attributes:
        routes: routes by MsgId, in the order of their ids. The bus's own look-ups go straight here.
    """

    def __init__(self, capacity: int, highest: int) -> None:
        self._capacity = capacity
        self._highest = highest
        self.routes: dict[int, Route] = {}
        self._table: list[Route] = []

    def init(self) -> None:
        """Forget all routes (CFE_SBR_Init, CFE_SBR_Init_Map)."""
        self.routes.clear()
        self._table.clear()

    def add_route(self, msg_id: int) -> int:
        """Make the route of a MsgId that has none (CFE_SBR_AddRoute, CFE_SBR_SetRouteId).

        Returns:
            Its id; INVALID_ROUTE_ID for an invalid MsgId and when the table is full.
        """
        if not 0 < msg_id <= self._highest or len(self._table) >= self._capacity:
            return INVALID_ROUTE_ID
        route = Route(msg_id, self.value_to_route_id(len(self._table)))
        self._table.append(route)
        self.routes[msg_id] = route
        return route.route_id

    def get_route_id(self, msg_id: int) -> int:
        """The id of a MsgId's route, INVALID_ROUTE_ID when it never had a subscriber (CFE_SBR_GetRouteId)."""
        route = self.routes.get(msg_id)
        return route.route_id if route is not None else INVALID_ROUTE_ID

    def route(self, route_id: int) -> Route | None:
        """The route of an id."""
        index = self.route_id_to_value(route_id)
        return self._table[index] if 0 <= index < len(self._table) else None

    def get_msg_id(self, route_id: int) -> int:
        """The MsgId of a route, INVALID_MSG_ID when there is none (CFE_SBR_GetMsgId)."""
        route = self.route(route_id)
        return route.msg_id if route is not None else INVALID_MSG_ID

    def get_dest_list_head_ptr(self, route_id: int) -> list[Destination]:
        """The destinations of a route, newest first (CFE_SBR_GetDestListHeadPtr)."""
        route = self.route(route_id)
        return list(route.destinations) if route is not None else []

    def set_dest_list_head_ptr(self, route_id: int, destinations: list[Destination]) -> None:
        """Replace the destinations of a route (CFE_SBR_SetDestListHeadPtr)."""
        route = self.route(route_id)
        if route is not None:
            route.destinations[:] = destinations
            route.refresh()

    def increment_sequence_counter(self, route_id: int) -> None:
        """Count one message (CFE_SBR_IncrementSequenceCounter)."""
        route = self.route(route_id)
        if route is not None:
            route.sequence += 1

    def get_sequence_counter(self, route_id: int) -> int:
        """The sequence count of the last message that the bus numbered, 0 to 0x3FFF (CFE_SBR_GetSequenceCounter)."""
        route = self.route(route_id)
        return route.sequence & MAX_SEQUENCE_COUNT if route is not None else 0

    def for_each_route_id(self, callback: Callable[[int], object], throttle: Throttle | None = None) -> None:
        """Call a function with the id of each route, in the order in which they were made (CFE_SBR_ForEachRouteId).

        Args:
            callback: called with each id.
            throttle: where to begin and how far to go; None does all.
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
        """Whether an id is one that the table can give (CFE_SBR_IsValidRouteId)."""
        return 0 < route_id <= self._capacity

    @staticmethod
    def value_to_route_id(value: int) -> int:
        """The id of an index of the table (CFE_SBR_ValueToRouteId)."""
        return value + 1

    @staticmethod
    def route_id_to_value(route_id: int) -> int:
        """The index of a route in the table, from 0 (CFE_SBR_RouteIdToValue)."""
        return route_id - 1
