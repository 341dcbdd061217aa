"""The bridge between a mission's virtual network and this computer's loopback interface.

A port that an application binds is opened on 127.0.0.1 too; data that arrives there enters the mission at its current
virtual time, with a record in the trace. A datagram for a port that no socket in the mission has bound is sent to
127.0.0.1. No other interface is used. The pacer sleeps in `wait`, which input ends; after every part of the run
`exchange` transfers all waiting bytes. Each TCP connection is a `HostConnection`: a real socket connected to a virtual
one.
"""

from __future__ import annotations

import select
import socket
import time
from collections.abc import Callable, Mapping
from types import TracebackType
from typing import Any, Protocol

from cfepy.ground import GroundLink
from cfepy.mission import Mission, OutsideStream
from cfepy.osal import LONGEST_DATAGRAM, Datagram, Endpoint, Listener, Place, Stream
from cfepy.status import UsageError

LOOPBACK = "127.0.0.1"
DIAL_S = 1.0  # wall time; a program on the same computer answers at once
MOST_AT_ONCE = 256  # datagrams of a port that are brought in between two parts of a run
UDP, TCP = "UDP", "TCP"
CHUNK = 65_536


class Guest(Protocol):
    """Other input from outside, brought in at the same times."""

    def fileno(self) -> int:
        """Return the files that become readable when there is input."""

    def exchange(self) -> None:
        """Bring in the input."""


class HostNetwork:
    """Real sockets for the virtual ones of a mission.

    A port that was opened stays open until the end, so that a reset of the processor does not give it away.

    Args:
        mission: the mission.
        ports: ports of the mission with another number on this computer; 0 for any free one.
        tell: receives a line about each port that was opened, and about failed deliveries.
    """

    def __init__(
        self,
        mission: Mission,
        ports: Mapping[int, int] | None = None,
        tell: Callable[[str], object] = lambda line: None,
    ) -> None:
        self._mission = mission
        self._ports = dict(ports or {})
        self._tell = tell
        self._open: dict[tuple[str, int], socket.socket] = {}
        self._connections: list[HostConnection] = []
        self._outbox: list[Datagram] = []
        self._anonymous = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self._anonymous.setblocking(False)
        self._foreign: list[str] = []
        self._replies: dict[int, socket.socket] = {}
        self._guests: list[Guest] = []
        self._link = GroundLink(mission, self._outbox.append)
        mission.network.dial = self._dial

    def __enter__(self) -> HostNetwork:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, where: TracebackType | None
    ) -> None:
        self.close()

    def host_port(self, port: int, protocol: str = UDP) -> int | None:
        """Return the port on this computer for a port of the mission; None if it is not open."""
        opened = self._open.get((protocol, port))
        return None if opened is None else int(opened.getsockname()[1])

    def join(self, guest: Guest) -> None:
        """Add another source of input."""
        self._guests.append(guest)

    def wait(self, seconds: float) -> None:
        """Sleep, at most until there is something to receive or to send."""
        readers: list[Any] = [
            opened for (protocol, port), opened in self._open.items() if protocol == UDP or self._has_room(port)
        ]
        readers += [connection.host for connection in self._connections if connection.wants_to_read]
        readers += self._replies.values()
        readers += self._guests
        writers = [connection.host for connection in self._connections if connection.wants_to_write]
        if not readers and not writers:
            time.sleep(seconds)
            return
        try:
            select.select(readers, writers, [], seconds)
        except ValueError:  # a program with 1024 open files: select does not support their numbers
            _poll(readers, writers, seconds)

    def exchange(self) -> None:
        """Open newly bound ports, bring in received data, and send waiting data.

        Raises:
            UsageError: if a port is taken on this computer.
        """
        self._mirror()
        for (protocol, port), opened in list(self._open.items()):
            if protocol == UDP:
                self._bring_in(port, opened)
            else:
                self._accept(port, opened)
        for port, opened in list(self._replies.items()):
            self._bring_in(port, opened)
            if (False, port) not in self._mission.network.datagrams.bound:
                self._replies.pop(port).close()
        self._connections = [connection for connection in self._connections if connection.move()]
        while self._outbox:
            self._send_out(self._outbox.pop(0))
        for guest in self._guests:
            guest.exchange()

    def close(self) -> None:
        """Send the remaining data, and close everything."""
        while self._outbox:
            self._send_out(self._outbox.pop(0))
        for connection in self._connections:
            connection.close()
        for opened in (*self._open.values(), *self._replies.values(), self._anonymous):
            opened.close()
        self._mission.network.dial = None
        self._link.close()

    # -- ports -------------------------------------------------------------------------------------------------------

    def _mirror(self) -> None:
        network = self._mission.network
        for protocol, ports in ((UDP, network.datagrams), (TCP, network.streams)):
            for (is_ip6, port), endpoints in ports.bound.items():
                if not is_ip6 and (protocol, port) not in self._open and _is_public(endpoints[0]):
                    self._open[protocol, port] = self._open_port(protocol, port)

    def _open_port(self, protocol: str, port: int) -> socket.socket:
        opened = socket.socket(socket.AF_INET, socket.SOCK_DGRAM if protocol == UDP else socket.SOCK_STREAM)
        opened.setblocking(False)
        try:
            if protocol == TCP:
                opened.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
            opened.bind((LOOPBACK, self._ports.get(port, port)))
            if protocol == TCP:
                opened.listen()
        except OSError as error:
            opened.close()
            where = f"{protocol} port {self._ports.get(port, port)} of {LOOPBACK} cannot be opened: {error.strerror}"
            raise UsageError(f"{where}; map the mission's port {port} to another one: --port {port}=NUMBER") from None
        self._tell(f"{protocol} port {port} is open at {LOOPBACK}:{opened.getsockname()[1]}")
        return opened

    # -- datagrams ---------------------------------------------------------------------------------------------------

    def _bring_in(self, port: int, opened: socket.socket) -> None:
        for _ in range(MOST_AT_ONCE):
            try:
                data, (host, source) = opened.recvfrom(LONGEST_DATAGRAM)
            except OSError:  # nothing more to receive
                return
            self._link.send(data, port, Place(host, source))

    def _send_out(self, datagram: Datagram) -> None:
        target = datagram.target
        if target.is_ip6 or not target.is_here:
            self._refuse(target.host)
            return
        opened = self._open.get((UDP, datagram.source.port)) or self._for_replies(datagram.source.port)
        try:
            opened.sendto(datagram.data, (target.reached().host, self._ports.get(target.port, target.port)))
        except OSError as error:
            self._tell(f"a datagram for port {target.port} could not be sent: {error.strerror}")

    def _for_replies(self, port: int) -> socket.socket:
        """Return the socket that sends for a port that is not open on this computer, and that receives the answers.

        If the mission has closed the port meanwhile, the answers of the returned socket are not read.
        """
        if (False, port) not in self._mission.network.datagrams.bound:
            return self._anonymous
        opened = self._replies.get(port)
        if opened is None:
            opened = self._replies[port] = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            opened.setblocking(False)
            opened.bind((LOOPBACK, 0))
        return opened

    def _refuse(self, host: str) -> None:
        if host not in self._foreign:
            self._foreign.append(host)
            self._tell(f"datagrams for {host} are dropped, because only {LOOPBACK} is connected")

    # -- connections -------------------------------------------------------------------------------------------------

    def _dial(self, source: Place, target: Place) -> Stream | None:
        """Connect a program of the mission with one on this computer; None if there is no listener."""
        if target.is_ip6:
            return self._joined(source, target, None)
        host = socket.socket(socket.AF_INET, socket.SOCK_STREAM)
        host.settimeout(DIAL_S)
        try:
            host.connect((LOOPBACK, self._ports.get(target.port, target.port)))
        except OSError:
            host.close()
            return self._joined(source, target, None)
        return self._joined(source, target, host)

    def _joined(self, source: Place, target: Place, host: socket.socket | None) -> Stream | None:
        """Return the mission's end of a connection with a real socket; without a socket, the connection is refused."""
        ends = self._mission.outside.answer(source, target, host is not None)
        if ends is None or host is None:
            return None
        near, far = ends
        self._connections.append(HostConnection(host, far))
        return near

    def _accept(self, port: int, opened: socket.socket) -> None:
        while self._has_room(port):
            try:
                host, (name, source) = opened.accept()
            except OSError:  # no more connections
                return
            stream = self._mission.outside.call(port, Place(name, source))
            if stream is None:
                host.close()
            else:
                self._connections.append(HostConnection(host, stream))

    def _listener(self, port: int) -> Listener | None:
        """Return the listener at a port of the mission; None if it is closed."""
        listener = self._mission.network.streams.find(Place(LOOPBACK, port))
        return listener if listener is not None and listener.listening else None

    def _has_room(self, port: int) -> bool:
        """Return whether a waiting connection on this computer can be brought in or refused."""
        listener = self._listener(port)
        return listener is None or listener.has_room


def _poll(readers: list[Any], writers: list[Any], seconds: float) -> None:
    poll = select.poll()
    for each in readers:
        poll.register(each, select.POLLIN)
    for each in writers:
        poll.register(each, select.POLLOUT | (select.POLLIN if each in readers else 0))
    poll.poll(seconds * 1000)


def _is_public(endpoint: Endpoint) -> bool:
    """Return whether a program outside could want to reach an endpoint."""
    return endpoint.listening if isinstance(endpoint, Listener) else not endpoint.anonymous


class HostConnection:
    """Transfers bytes in both directions. A side that does not read holds the other side back.

    Args:
        host: the real socket, connected.
        stream: the end of the virtual connection for it.

    Attributes:
        host: the real socket.
    """

    def __init__(self, host: socket.socket, stream: OutsideStream) -> None:
        self.host = host
        self._stream = stream
        self._pending = b""  # sent by the virtual side, not yet taken by the real one
        self._host_ended = self._stream_ended = False
        host.setblocking(False)

    @property
    def wants_to_read(self) -> bool:
        """Whether there is room for bytes of the real side."""
        return not self._host_ended and self._stream.room > 0

    @property
    def wants_to_write(self) -> bool:
        """Whether there are bytes that the real side has not taken yet."""
        return bool(self._pending)

    def move(self) -> bool:
        """Transfer as much as possible; returns False if the connection has ended and is closed."""
        try:
            self._bring_in()
            self._send_out()
        except BlockingIOError:
            return True
        except OSError:  # the other program has ended
            self.close()
            return False
        if self._stream_ended and (self._host_ended or self._stream.alone):
            self.close()
            return False
        return True

    def close(self) -> None:
        """End both sides."""
        self._stream.close()
        self.host.close()

    def _bring_in(self) -> None:
        while self.wants_to_read:
            try:
                data = self.host.recv(min(CHUNK, self._stream.room))
            except BlockingIOError:
                return
            if not data:
                self._host_ended = True
                self._stream.end()
                return
            self._stream.write(data)

    def _send_out(self) -> None:
        while self._pending or self._stream.readable:
            self._pending = self._pending or self._stream.read(CHUNK)
            if not self._pending:
                break
            self._pending = self._pending[self.host.send(self._pending) :]
        if self._stream.ended and not self._stream_ended:
            self._stream_ended = True
            self.host.shutdown(socket.SHUT_WR)
