"""The single entry point for external input into a running mission: datagrams, connections and their bytes.

The ground link, the bridge to real sockets and a replay bring input in here, while the run is paused between two of its
parts. Only the mission's own calls to the outside are answered within a part. A listener gets each arrival, so a
journal has all of them and a replay can repeat them.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

from cfepy.osal import Datagram, Network, Place, Stream
from cfepy.rtos import Kernel
from cfepy.trace import Trace

LOOPBACK = "127.0.0.1"
DATAGRAM, CALL, ANSWER, BYTES, TAKEN, ENDED, CLOSED = "datagram", "call", "answer", "bytes", "taken", "ended", "closed"
ACT = "act"


class Arrival(NamedTuple):
    """An input from outside: its kind, and its plain values.

    DATAGRAM: port of the mission, host and port of the sender, data. CALL (an external connect): port, host and port of
    the caller. ANSWER (the mission connects): host and port of both sides, whether it was answered. For a connection,
    by its number from 0: BYTES that arrived, the number of bytes TAKEN by the outside, ENDED when the outside sends no
    more, CLOSED when it closes the connection. ACT: a host action (`cfepy.mission.host_actions`): its name and values.
    """

    kind: str
    values: tuple[Any, ...]


class Outside:
    """The outside of one mission.

    Args:
        kernel: the kernel of the simulated computer.
        network: the virtual network of its sockets.
        trace: gets a note of each input.

    Attributes:
        until_ns: the virtual time at which the present or last part of the run ends.
        visits: the number of the part among those with this end, from 1.
        listener: called with each arrival; None without one.
        do: performs host actions; set by the mission.
    """

    def __init__(self, kernel: Kernel, network: Network, trace: Trace) -> None:
        self.until_ns = -1
        self.visits = 0
        self.listener: Callable[[Arrival], object] | None = None
        self.do: Callable[..., Any]
        self._kernel = kernel
        self._network = network
        self._trace = trace
        self._streams: list[Stream] = []

    def begin_piece(self, until_ns: int) -> None:
        """Start a part of the run that ends at a virtual time in ns."""
        self.visits = self.visits + 1 if until_ns == self.until_ns else 1
        self.until_ns = until_ns

    def datagram(self, port: int, source: Place, data: bytes) -> bool:
        """Deliver a datagram to a port; return whether a socket took it."""
        self._tell(DATAGRAM, port, source.host, source.port, data)
        self._trace.note(f"uplink to {port} at {self._kernel.now}: {data.hex()}")
        mailbox = self._network.datagrams.find(Place(LOOPBACK, port))
        return mailbox is not None and mailbox.offer(Datagram(source, Place(LOOPBACK, port), data))

    def call(self, port: int, source: Place) -> OutsideStream | None:
        """Connect from outside to a port; return None if no socket accepts connections there."""
        listener = self._network.streams.find(Place(LOOPBACK, port))
        if listener is None or not listener.listening or not listener.has_room:
            return None
        self._tell(CALL, port, source.host, source.port)
        return self._keep(listener.connect(source, Place(LOOPBACK, port)))

    def answer(self, source: Place, target: Place, answered: bool) -> tuple[Stream, OutsideStream] | None:
        """Connect the mission to the outside, where the call was answered or not.

        Returns:
            The mission's end of the connection, and the outside's end.
        """
        self._tell(ANSWER, source.host, source.port, target.host, target.port, answered)
        if not answered:
            return None
        near, far = Stream(source, target), Stream(target, source)
        near.other, far.other = far, near
        return near, self._keep(far)

    def act(self, name: str, *values: Any) -> Any:
        """Perform a host action; see `HostActs.do` for arguments, result and errors."""
        self._tell(ACT, name, *values)
        return self.do(name, *values)

    def repeat(self, arrival: Arrival) -> None:
        """Repeat a recorded arrival, except an ANSWER, which is given when the mission connects.

        Raises:
            LookupError: if it is about an unknown connection.
        """
        kind, values = arrival
        if kind == DATAGRAM:
            port, host, source, data = values
            self.datagram(port, Place(host, source), data)
        elif kind == CALL:
            port, host, source = values
            self.call(port, Place(host, source))
        elif kind == ACT:
            try:
                self.act(*values)
            except Exception:  # it was also refused the first time, and the run continued
                pass
        else:
            self._repeat_on(self._stream(values[0]), kind, values)

    def _repeat_on(self, stream: OutsideStream, kind: str, values: tuple[Any, ...]) -> None:
        if kind == BYTES:
            stream.write(values[1])
        elif kind == TAKEN:
            stream.read(values[1])
        elif kind == ENDED:
            stream.end()
        elif kind == CLOSED:
            stream.close()
        else:
            raise LookupError(f"unknown event {kind!r}")

    def _stream(self, number: int) -> OutsideStream:
        if not 0 <= number < len(self._streams):
            raise LookupError(f"unknown connection {number}")
        return OutsideStream(self, number, self._streams[number])

    def _keep(self, stream: Stream) -> OutsideStream:
        self._streams.append(stream)
        return OutsideStream(self, len(self._streams) - 1, stream)

    def _tell(self, kind: str, *values: Any) -> None:
        if self.listener is not None:
            self.listener(Arrival(kind, values))


class OutsideStream:
    """The outside's end of a connection with the mission.

    Args:
        outside: the entry point.
        number: number of the connection.
        stream: the end of the virtual connection.
    """

    def __init__(self, outside: Outside, number: int, stream: Stream) -> None:
        self._outside = outside
        self._number = number
        self._stream = stream

    @property
    def room(self) -> int:
        """Bytes that the mission's end can accept now."""
        return self._stream.room

    @property
    def readable(self) -> bool:
        """Whether the mission has sent bytes, or will send no more."""
        return self._stream.readable

    @property
    def ended(self) -> bool:
        """Whether the mission will send no more."""
        return self._stream.ended or self._stream.dead

    @property
    def alone(self) -> bool:
        """Whether the mission has closed the connection."""
        return self._stream.other is None

    def write(self, data: bytes) -> None:
        """Bring in bytes; there must be room for them."""
        outside, port = self._outside, self._stream.remote.port
        outside._tell(BYTES, self._number, data)
        outside._trace.note(f"stream to {port} at {outside._kernel.now}: {data.hex()}")
        self._stream.write(data)

    def read(self, limit: int) -> bytes:
        """Take at most `limit` bytes that the mission has sent, which makes room for more."""
        data = self._stream.read(limit)
        if data:
            self._outside._tell(TAKEN, self._number, len(data))
        return data

    def end(self) -> None:
        """Stop sending from the outside."""
        self._outside._tell(ENDED, self._number)
        self._stream.shut(read=False, write=True)

    def close(self) -> None:
        """Close the connection from the outside."""
        self._outside._tell(CLOSED, self._number)
        self._stream.close()
