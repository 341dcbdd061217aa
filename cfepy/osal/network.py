"""The virtual network: who is bound to which address, and where a datagram goes.

It stands for the loopback interface on which all processors of a mission meet, and outlives each of them. It knows
nothing of descriptors (`cfepy.osal.sockets`). Nothing is lost or reordered by chance. May import its neighbour
endpoints.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Generic, TypeVar

from cfepy.osal.endpoints import Datagram, Endpoint, Listener, Mailbox, Place, Stream

FIRST_FREE_PORT, LAST_FREE_PORT = 32_768, 60_999  # given to sockets that ask for none

Bound = TypeVar("Bound", bound=Endpoint)


class Ports(Generic[Bound]):
    """Which endpoint is bound to which place, for one protocol.

    Attributes:
        bound: the endpoints by port and whether it is IPv6's, in the order in which they were bound.
    """

    def __init__(self) -> None:
        self.bound: dict[tuple[bool, int], list[Bound]] = {}
        self._next = FIRST_FREE_PORT

    def bind(self, endpoint: Bound, place: Place) -> Place | None:
        """Give an endpoint its place, port 0 any free one; None when that is taken or is not on this network."""
        if not place.is_here:
            return None
        endpoint.anonymous = place.port == 0
        if endpoint.anonymous:
            place = Place(place.host, self._free_port(place.is_ip6))
        others = self.bound.get((place.is_ip6, place.port), [])
        if any(_clash(place, other.place) for other in others):
            return None
        endpoint.place = place
        self.bound.setdefault((place.is_ip6, place.port), []).append(endpoint)
        return place

    def release(self, endpoint: Bound) -> None:
        """Take an endpoint away from its place, if it has one."""
        place = endpoint.place
        others = [] if place is None else self.bound.get((place.is_ip6, place.port), [])
        if place is not None and endpoint in others:
            others.remove(endpoint)
            if not others:
                del self.bound[place.is_ip6, place.port]

    def find(self, place: Place) -> Bound | None:
        """Who gets what is sent to a place."""
        for endpoint in self.bound.get((place.is_ip6, place.port), ()):
            if endpoint.place is not None and endpoint.place.host in (place.host, place.any_host):
                return endpoint
        return None

    def _free_port(self, is_ip6: bool) -> int:
        while (is_ip6, self._next) in self.bound:
            self._next = FIRST_FREE_PORT if self._next == LAST_FREE_PORT else self._next + 1
        return self._next


def _clash(place: Place, other: Place | None) -> bool:
    return other is not None and (place.host == other.host or place.any_host in (place.host, other.host))


class Network:
    """What the sockets of all processors of a mission are plugged into.

    Attributes:
        datagrams: who is bound to which UDP port.
        streams: who is bound to which TCP port.
        outlets: called with each datagram that nobody here is bound for: the ways out, such as the ground link.
        dial: asked for a connection from a place to one where nobody here listens, None when nobody does there either;
            only a network that is joined to another one has it.
    """

    def __init__(self) -> None:
        self.datagrams: Ports[Mailbox] = Ports()
        self.streams: Ports[Listener] = Ports()
        self.outlets: list[Callable[[Datagram], object]] = []
        self.dial: Callable[[Place, Place], Stream | None] | None = None

    def send(self, datagram: Datagram) -> bool:
        """Bring a datagram to who is bound to its target, else to every outlet; whether anybody here took it."""
        mailbox = self.datagrams.find(datagram.target.reached())
        if mailbox is not None:
            return mailbox.offer(datagram)
        for outlet in self.outlets:
            outlet(datagram)
        return False
