"""The virtual network: the addresses of endpoints, the routing of datagrams, and the ends of connections.

It models the loopback interface that all processors of a mission share, and it outlives the processors. It does not
know descriptors (`cfepy.osal.sockets`). No datagram is lost or reordered by chance. An endpoint never waits. It
announces each change, and waiting tasks check again.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable
from typing import Generic, NamedTuple, TypeVar

from cfepy.rtos import Kernel, WaitList

DATAGRAM_BUFFER = 212_992  # bytes that may wait at a datagram socket, Linux's default
DATAGRAM_OVERHEAD = 768  # bytes that each datagram takes in addition to its data
LONGEST_DATAGRAM = 65_507  # the largest UDP payload
STREAM_BUFFER = 65_536  # bytes in flight in one direction of a connection
BACKLOG = 10  # connections that wait to be accepted
FIRST_FREE_PORT, LAST_FREE_PORT = 32_768, 60_999  # for sockets that request any port


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
        """The text of the host address that means all hosts."""
        return "::" if self.is_ip6 else "0.0.0.0"

    @property
    def is_here(self) -> bool:
        """Whether it is on the loopback interface, the only interface."""
        return self.host in ("0.0.0.0", "::", "::1") or self.host.startswith("127.")

    @property
    def is_group(self) -> bool:
        """Whether it is the broadcast address or a multicast address, to which Linux lets datagram sockets be bound."""
        first = self.host.partition(".")[0]
        return self.host == "255.255.255.255" or (first.isdecimal() and 224 <= int(first) < 240)

    def reached(self) -> Place:
        """Return the address as the peer sees it: a socket bound to all hosts answers from the loopback address."""
        if self.host != self.any_host:
            return self
        return Place("::1" if self.is_ip6 else "127.0.0.1", self.port)


class Datagram(NamedTuple):
    """A datagram in flight."""

    source: Place
    target: Place
    data: bytes


class Endpoint:
    """One end of the network, with the tasks that wait for a change at it.

    Attributes:
        place: the address it is bound to; None before.
        anonymous: whether it took any free port, so that programs cannot know its port in advance.
        shares: whether another endpoint that shares may have the same address, by SO_REUSEADDR, which OSAL sets.
    """

    def __init__(self, place: Place | None = None) -> None:
        self.place = place
        self.anonymous = False
        self.shares = True
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
        """Wake the tasks in `waits` at each change."""
        self._watchers.append((kernel, waits))

    def unwatch(self, kernel: Kernel, waits: WaitList) -> None:
        """Undo `watch`."""
        self._watchers.remove((kernel, waits))

    def changed(self) -> None:
        """Announce a change; waiting tasks check again. A more urgent task runs before this call returns."""
        for kernel, waits in tuple(self._watchers):
            kernel.wake_all(waits)


class Mailbox(Endpoint):
    """The end of a datagram socket: the received datagrams that were not read yet, in order.

    Attributes:
        peer: the address it is connected to; only datagrams from there are accepted. None accepts all.
        lost: number of datagrams dropped because the buffer was full.
        refused: whether a datagram to the peer found no socket, which the next call reports.
        read_shut, write_shut: whether it was shut down for reading or writing.
    """

    def __init__(self) -> None:
        super().__init__()
        self.peer: Place | None = None
        self.lost = 0
        self.refused = self.read_shut = self.write_shut = False
        self._inbox: deque[Datagram] = deque()
        self._used = 0

    @property
    def readable(self) -> bool:
        return bool(self._inbox) or self.refused or self.read_shut

    @property
    def is_empty(self) -> bool:
        """Whether no datagram waits."""
        return not self._inbox

    def take_refusal(self) -> bool:
        """Return whether the peer refused a datagram, and forget it."""
        refused, self.refused = self.refused, False
        return refused

    def offer(self, datagram: Datagram) -> bool:
        """Accept a datagram; return False if there is no room or it is not from the peer."""
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
        """Remove and return the oldest datagram."""
        datagram = self._inbox.popleft()
        self._used -= len(datagram.data) + DATAGRAM_OVERHEAD
        return datagram

    def peek(self) -> Datagram:
        """Return the oldest datagram without removing it."""
        return self._inbox[0]


class Stream(Endpoint):
    """One end of a connection, which ends as on Linux.

    Args:
        place: address of this end.
        remote: address of the other end.
        is_tcp: False for a pair in one computer, which reports the end of the other end at once.

    Attributes:
        other: the other end; None if it is closed.
        remote: address of the other end.
        ended: whether the other end will send no more.
        dead: whether both ends are through, or one of them was reset.
        read_shut, write_shut: whether this end was shut down for reading or writing.
    """

    def __init__(self, place: Place, remote: Place, is_tcp: bool = True) -> None:
        super().__init__(place)
        self._is_tcp = is_tcp
        self.remote = remote
        self.other: Stream | None = None
        self.ended = self.dead = self.read_shut = self.write_shut = False
        self._was_reset = False  # not reported yet
        self._incoming = bytearray()

    @property
    def readable(self) -> bool:
        return bool(self._incoming) or self.ended or self.read_shut or self.dead

    @property
    def writable(self) -> bool:
        return self.write_shut or self.dead or self.other is None or self.room > 0

    @property
    def room(self) -> int:
        """Bytes that the other end can accept now."""
        return 0 if self.other is None else STREAM_BUFFER - len(self.other._incoming)

    def take_reset(self) -> bool:
        """Return whether the next read must report that the other end reset the connection, and forget it."""
        if self._incoming or not self._was_reset:
            return False
        self._was_reset = False
        return True

    def read(self, limit: int) -> bytes:
        """Return at most `limit` received bytes, or b"" at the end of the stream; ask `take_reset` before."""
        data = bytes(self._incoming[:limit])
        del self._incoming[:limit]
        if data and self.other is not None:
            self.other.changed()
        return data

    def peek(self, limit: int) -> bytes:
        """Return the bytes that `read` would return, without removing them."""
        return bytes(self._incoming[:limit])

    def write(self, data: bytes) -> int | None:
        """Send as many bytes as there is room for; return their number, or None if the connection is over.

        The first bytes to an end that was closed are lost. They only cause the reset that ends this end.
        """
        if self.write_shut or self.dead:
            self._was_reset = False
            return None
        other = self.other
        if other is None:
            self.reset()
            return len(data) if self._is_tcp else None
        count = min(len(data), self.room)
        if other.read_shut and other.write_shut:  # it would never read them
            other.reset()
            self.reset()
            return count
        other._incoming += data[:count]
        other.changed()
        return count

    def reset(self) -> None:
        """End the connection as the other end's reset does; received bytes stay readable."""
        self._was_reset = not self.ended and not self.dead
        self.dead = True
        self.changed()

    def shut(self, read: bool, write: bool) -> bool:
        """Shut this end down for reading or writing; return False if the connection is over."""
        if self.dead:
            return False
        self.read_shut |= read
        if write and not self.write_shut:
            self.write_shut = True
            if self.other is not None:
                self.other.ended = True
                self.other._end_if_both_did()
                self.other.changed()
            self._end_if_both_did()
        self.changed()
        return True

    def close(self) -> None:
        """Close this end. The other end can still read the bytes already sent, unless bytes are unread here: then it is
        reset.
        """
        if self._incoming:
            self.abort()
            return
        other, self.other = self.other, None
        if other is not None:
            other.other = None
            other.ended = True
            other._end_if_both_did()
            other.changed()
        self.changed()

    def abort(self) -> None:
        """Close this end, and reset the other."""
        other, self.other = self.other, None
        if other is not None:
            other.other = None
            other.reset()
        self.changed()

    def _end_if_both_did(self) -> None:
        self.dead |= self.write_shut and self.ended


class Listener(Endpoint):
    """The end of a bound stream socket; it accepts connections while it listens.

    Attributes:
        listening: whether it accepts connections.
        pending: connections not accepted yet, oldest first.
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
        """Whether another connection can wait here."""
        return len(self.pending) < BACKLOG

    def connect(self, source: Place, target: Place) -> Stream:
        """Create a connection that waits to be accepted, and return the caller's end; requires `has_room`."""
        near, far = Stream(source, target), Stream(target, source)
        near.other, far.other = far, near
        self.pending.append(far)
        self.changed()
        return near

    def accept(self) -> Stream:
        """Return the oldest waiting connection."""
        stream = self.pending.popleft()
        self.changed()
        return stream

    def close(self) -> None:
        """Stop listening, and reset the waiting connections."""
        self.listening = False
        while self.pending:
            self.pending.popleft().abort()
        self.changed()


Bound = TypeVar("Bound", bound=Endpoint)


class BoundEndpoints(Generic[Bound]):
    """The addresses of bound endpoints, for one protocol.

    Args:
        shares: whether several endpoints that share can have one address, as UDP sockets with SO_REUSEADDR.

    Attributes:
        bound: the endpoints by (whether it is IPv6, port), in the order of binding.
    """

    def __init__(self, shares: bool) -> None:
        self._shares = shares
        self.bound: dict[tuple[bool, int], list[Bound]] = {}
        self._next = FIRST_FREE_PORT

    def bind(self, endpoint: Bound, place: Place) -> Place | None:
        """Bind an endpoint to an address; port 0 means any free port.

        Returns:
            The address, or None if it is not on this network, or taken and not shared.
        """
        if not (place.is_here or (self._shares and place.is_group)):
            return None
        endpoint.anonymous = place.port == 0
        if endpoint.anonymous:
            place = Place(place.host, self._free_port(place.is_ip6))
        others = self.bound.get((place.is_ip6, place.port), [])
        for other in others:
            if not (self._shares and endpoint.shares and other.shares) and _clash(place, other.place):
                return None
        endpoint.place = place
        self.bound.setdefault((place.is_ip6, place.port), []).append(endpoint)
        return place

    def release(self, endpoint: Bound) -> None:
        """Release the address of an endpoint, if it has one."""
        place = endpoint.place
        others = [] if place is None else self.bound.get((place.is_ip6, place.port), [])
        if place is not None and endpoint in others:
            others.remove(endpoint)
            if not others:
                del self.bound[place.is_ip6, place.port]

    def find(self, place: Place) -> Bound | None:
        """Return the endpoint that receives data sent to an address, or None.

        Of several, that is one bound to just this host, and of these the newest, as on Linux.
        """
        best: Bound | None = None
        for endpoint in self.bound.get((place.is_ip6, place.port), ()):
            host = None if endpoint.place is None else endpoint.place.host
            if host == place.host or (host == place.any_host and (best is None or best.place != place)):
                best = endpoint
        return best

    def _free_port(self, is_ip6: bool) -> int:
        while (is_ip6, self._next) in self.bound:
            self._next = FIRST_FREE_PORT if self._next == LAST_FREE_PORT else self._next + 1
        return self._next


def _clash(place: Place, other: Place | None) -> bool:
    return other is not None and (place.host == other.host or place.any_host in (place.host, other.host))


class Network:
    """The network that connects the sockets of all processors of a mission.

    Attributes:
        datagrams: the endpoints of UDP ports.
        streams: the endpoints of TCP ports.
        outlets: called with each datagram that has no bound socket here, such as the ground link.
        dial: requests a connection to an address where no socket here listens; returns None if no program there listens
            either. Only a network that is joined to another one has it.
    """

    def __init__(self) -> None:
        self.datagrams: BoundEndpoints[Mailbox] = BoundEndpoints(shares=True)
        self.streams: BoundEndpoints[Listener] = BoundEndpoints(shares=False)
        self.outlets: list[Callable[[Datagram], object]] = []
        self.dial: Callable[[Place, Place], Stream | None] | None = None

    def refuses(self, target: Place) -> bool:
        """Return whether no socket takes datagrams for an address, and nothing outside can take them."""
        return not self.outlets and self.datagrams.find(target.reached()) is None

    def send(self, datagram: Datagram) -> bool:
        """Deliver a datagram to the endpoint of its target, or otherwise to every outlet.

        Returns:
            Whether an endpoint accepted it.
        """
        mailbox = self.datagrams.find(datagram.target.reached())
        if mailbox is not None:
            return mailbox.offer(datagram)
        for outlet in self.outlets:
            outlet(datagram)
        return False
