"""The virtual network: which endpoint is bound to which address, where datagrams go, and the ends of connections.

It stands for the loopback interface on which all processors of a mission meet, and outlives each of them. It knows
nothing of descriptors (`cfepy.osal.sockets`). No datagram is lost or reordered by chance. An endpoint never waits: it
announces each change, and the tasks that wait look again.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Generic, NamedTuple, TypeVar

from cfepy.rtos import Kernel, WaitList

DATAGRAM_BUFFER = 212_992  # bytes that wait at a datagram socket, Linux's default ...
DATAGRAM_OVERHEAD = 768  # ... of which every datagram takes this much in addition to its data
LONGEST_DATAGRAM = 65_507  # the most that UDP carries
STREAM_BUFFER = 65_536  # bytes on their way in one direction of a connection
BACKLOG = 10  # connections that wait to be accepted
FIRST_FREE_PORT, LAST_FREE_PORT = 32_768, 60_999  # given to sockets that ask for none


class Place(NamedTuple):
    """An address on the network: a host as text, "127.0.0.1" or "::1", and a port."""

    host: str
    port: int

    @property
    def is_ip6(self) -> bool:
        """Whether it belongs to IPv6."""
        return ":" in self.host

    @property
    def any_host(self) -> str:
        """How the host is written that stands for all of them."""
        return "::" if self.is_ip6 else "0.0.0.0"

    @property
    def is_here(self) -> bool:
        """Whether it is on the loopback interface, the only one there is."""
        return self.host in ("0.0.0.0", "::", "::1") or self.host.startswith("127.")

    def reached(self) -> Place:
        """The place as the other side sees it: a socket bound to all hosts answers from the loopback address."""
        if self.host != self.any_host:
            return self
        return Place("::1" if self.is_ip6 else "127.0.0.1", self.port)


class Datagram(NamedTuple):
    """A datagram under way."""

    source: Place
    target: Place
    data: bytes


class Endpoint:
    """One end of the network, and the tasks that wait for something to happen at it.

    Attributes:
        place: where it is bound; None before.
        anonymous: whether it took any free port, so that no program can know it beforehand.
    """

    def __init__(self, place: Place | None = None) -> None:
        self.place = place
        self.anonymous = False
        self._watchers: list[tuple[Kernel, WaitList]] = []

    @property
    def readable(self) -> bool:
        """Whether a read would not have to wait."""
        return True

    @property
    def writable(self) -> bool:
        """Whether a write would not have to wait."""
        return True

    def watch(self, kernel: Kernel, waits: WaitList) -> None:
        """Wake the tasks that wait in `waits` whenever something changes here."""
        self._watchers.append((kernel, waits))

    def unwatch(self, kernel: Kernel, waits: WaitList) -> None:
        """The end of `watch`."""
        self._watchers.remove((kernel, waits))

    def changed(self) -> None:
        """Something happened here; tasks that wait look again. A more urgent task runs before this returns."""
        for kernel, waits in tuple(self._watchers):
            kernel.wake_all(waits)


class Mailbox(Endpoint):
    """The end of a datagram socket: what arrived and was not read yet, in order.

    Attributes:
        peer: the place it is connected to, the only one whose datagrams come in; None lets all in.
        lost: datagrams that found no room.
    """

    def __init__(self) -> None:
        super().__init__()
        self.peer: Place | None = None
        self.lost = 0
        self._inbox: deque[Datagram] = deque()
        self._used = 0

    @property
    def readable(self) -> bool:
        return bool(self._inbox)

    def offer(self, datagram: Datagram) -> bool:
        """Take a datagram in; False when there is no room, or when it is not from the peer."""
        if self.peer is not None and self.peer.reached() != datagram.source:
            return False
        size = len(datagram.data) + DATAGRAM_OVERHEAD
        if self._used + size > DATAGRAM_BUFFER:
            self.lost += 1
            return False
        self._used += size
        self._inbox.append(datagram)
        self.changed()
        return True

    def take(self) -> Datagram:
        """The oldest datagram."""
        datagram = self._inbox.popleft()
        self._used -= len(datagram.data) + DATAGRAM_OVERHEAD
        return datagram

    def peek(self) -> Datagram:
        """The oldest datagram, which stays."""
        return self._inbox[0]


class Stream(Endpoint):
    """One end of a connection.

    Attributes:
        other: the other end; None when that was closed.
        remote: where the other end is.
        ended: the other end sends no more.
        read_shut, write_shut: this end wants to read or write no more.
    """

    def __init__(self, place: Place, remote: Place) -> None:
        super().__init__(place)
        self.remote = remote
        self.other: Stream | None = None
        self.ended = self.read_shut = self.write_shut = False
        self._incoming = bytearray()

    @property
    def readable(self) -> bool:
        return bool(self._incoming) or self.ended or self.read_shut

    @property
    def writable(self) -> bool:
        return self.write_shut or self.other is None or self.room > 0

    @property
    def room(self) -> int:
        """Bytes that the other end would take now."""
        return 0 if self.other is None else STREAM_BUFFER - len(self.other._incoming)

    def read(self, limit: int) -> bytes:
        """At most so many of the bytes that arrived; none of them at the end of the stream."""
        data = bytes(self._incoming[:limit])
        del self._incoming[:limit]
        if data and self.other is not None:
            self.other.changed()
        return data

    def peek(self, limit: int) -> bytes:
        """What `read` would return."""
        return bytes(self._incoming[:limit])

    def write(self, data: bytes) -> int | None:
        """Send as many bytes as there is room for; how many, or None when no reader is left."""
        if self.write_shut or self.other is None:
            return None
        count = min(len(data), self.room)
        self.other._incoming += data[:count]
        self.other.changed()
        return count

    def shut(self, read: bool, write: bool) -> None:
        """Read or write no more."""
        self.read_shut |= read
        if write and not self.write_shut:
            self.write_shut = True
            if self.other is not None:
                self.other.ended = True
                self.other.changed()
        self.changed()

    def close(self) -> None:
        """Leave the connection; the other end may still read what was sent."""
        other, self.other = self.other, None
        if other is not None:
            other.other = None
            other.ended = True
            other.changed()
        self.changed()


class Listener(Endpoint):
    """The end of a stream socket that is bound: connections come in when it listens.

    Attributes:
        listening: whether it takes connections.
        pending: connections that are not accepted yet, oldest first.
    """

    def __init__(self) -> None:
        super().__init__()
        self.listening = False
        self.pending: deque[Stream] = deque()

    @property
    def readable(self) -> bool:
        return bool(self.pending)

    @property
    def has_room(self) -> bool:
        """Whether another connection could wait here."""
        return len(self.pending) < BACKLOG

    def connect(self, source: Place, target: Place) -> Stream:
        """Make a connection that waits to be accepted; the caller's end of it. Only with `has_room`."""
        near, far = Stream(source, target), Stream(target, source)
        near.other, far.other = far, near
        self.pending.append(far)
        self.changed()
        return near

    def accept(self) -> Stream:
        """The oldest connection that waits."""
        stream = self.pending.popleft()
        self.changed()
        return stream

    def close(self) -> None:
        """Take no more connections, and drop those that wait."""
        self.listening = False
        while self.pending:
            self.pending.popleft().close()
        self.changed()


Bound = TypeVar("Bound", bound=Endpoint)


class BoundEndpoints(Generic[Bound]):
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
        """The endpoint that gets what is sent to a place."""
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
        datagrams: the endpoints by the UDP port that they are bound to.
        streams: the endpoints by the TCP port that they are bound to.
        outlets: called with each datagram for which no socket here is bound: the ways out, such as the ground link.
        dial: asked for a connection to a place where no socket here listens; None when no program there listens either;
            only a network that is joined to another one has it.
    """

    def __init__(self) -> None:
        self.datagrams: BoundEndpoints[Mailbox] = BoundEndpoints()
        self.streams: BoundEndpoints[Listener] = BoundEndpoints()
        self.outlets: list[Callable[[Datagram], object]] = []
        self.dial: Callable[[Place, Place], Stream | None] | None = None

    def send(self, datagram: Datagram) -> bool:
        """Bring a datagram to the endpoint bound to its target, else to every outlet; whether an endpoint took it."""
        mailbox = self.datagrams.find(datagram.target.reached())
        if mailbox is not None:
            return mailbox.offer(datagram)
        for outlet in self.outlets:
            outlet(datagram)
        return False
