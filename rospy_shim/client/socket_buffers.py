"""The sockets between a publisher and a subscriber whose callback is too slow for long messages.

In rospy a subscriber's `queue_size` drops messages only among those that one read of `buff_size` bytes brought. The
bytes of all others wait in the buffers of the two sockets. So with messages longer than `buff_size` every message is
handled, the oldest first, and the lag grows until the buffers are full. Then a publisher without `queue_size` waits in
`publish`, and one with a `queue_size` drops its own oldest messages. `buff_size=2**24` is the cure.

A mission's pipes and the bus's memory are too small for this. So once the pipe of a subscription is full, and more
bytes wait than one read brings, its messages wait in `SocketBuffers` until the subscriber has caught up. While all of
them fit in one read, the pipe alone drops the oldest message, and nothing here is used.
"""

from __future__ import annotations

from collections import deque
from dataclasses import dataclass
from itertools import accumulate, islice
from typing import TYPE_CHECKING, NamedTuple

from cfepy.rtos import WaitList
from cfepy.units import NS_PER_S
from rospy_shim.types.transport import HEADER_BYTES, LAST

if TYPE_CHECKING:
    from collections.abc import Collection

    from cfepy.rtos import Kernel
    from cfepy.sb import Destination, Waiting

SOCKET_BYTES = 4 << 20
"""Bytes of both sockets' buffers: the largest send buffer of Linux (net.ipv4.tcp_wmem). Measured on the loopback
interface: 3.3 to 4.4 MB, depending on when the buffers grew."""
FEW = 32  # packets that are not counted; a packet has at most 64 KiB
LENGTH_BYTES = 4  # before each message
CURE = "2**24"


def wire_bytes(waiting: Waiting) -> int:
    """Return the bytes of a whole message on the wire, from its packet."""
    return len(waiting[0]) - HEADER_BYTES + LENGTH_BYTES


def is_full(packets: Collection[Waiting], size: int) -> bool:
    """Return True if sockets that hold some packets have no room for a message of so many bytes."""
    if len(packets) < FEW:
        return False
    return sum(len(each[0]) - HEADER_BYTES for each in packets) + size > SOCKET_BYTES


class _Message(NamedTuple):
    """A whole message that waits: its bytes on the wire, its packets, and the virtual time at which it was sent."""

    size: int
    packets: int
    at_ns: int


class SocketBuffers:
    """The messages between a topic's publishers and one subscription that is behind.

    Args:
        kernel: the kernel of the tasks.
        name: name of the connection for reports.

    Attributes:
        leaves_newer: whether the last read left whole messages behind, which are newer than those it brought.
    """

    def __init__(self, kernel: Kernel, name: str) -> None:
        self.leaves_newer = False
        self._kernel = kernel
        self._packets: deque[Waiting] = deque()
        self._messages: deque[_Message] = deque()
        self._part = self._part_packets = 0  # of a message whose last packet has not come
        self._bytes = 0  # of all of them
        self._read = 0  # bytes at the front that the subscriber has read, of a message that it does not have whole
        self._ahead = 0  # messages that it has read whole, and that are still to be handled
        self._queued = 0  # messages at the end that wait in the queue of their publisher
        self._taken: Destination | None = None  # counts the packets that the subscriber gets from its pipe
        self._taken_until = 0
        self._room = WaitList(f"room in the sockets of {name}")

    def __bool__(self) -> bool:
        return bool(self._packets)

    @property
    def loose(self) -> int:
        """The packets from `take` that the subscriber has not got from its pipe yet."""
        return 0 if self._taken is None else max(0, self._taken_until - self._taken.gets)

    @property
    def first(self) -> bytes:
        """The packet at the front; there must be one."""
        return self._packets[0][0]

    # -- the publisher's side ------------------------------------------------------------------------------------------

    def begin_with(self, unused: int) -> None:
        """Take all messages so far as read, and some bytes behind them."""
        self._ahead = len(self._messages)
        self._read = self._bytes + unused

    def add(self, packets: list[Waiting], queue_size: int | None = None) -> list[Waiting]:
        """Add packets behind the others.

        Args:
            packets: the packets.
            queue_size: messages that their publisher keeps while the sockets are full; 0 for no limit, and None for a
                publisher that has waited for room.

        Returns:
            The packets of the messages that the publisher's queue drops.
        """
        dropped: list[Waiting] = []
        for each in packets:
            packet = each[0]
            self._packets.append(each)
            self._part += len(packet) - HEADER_BYTES
            self._part_packets += 1
            self._bytes += len(packet) - HEADER_BYTES
            if packet[2] & LAST:
                self._bytes += LENGTH_BYTES
                self._messages.append(_Message(self._part + LENGTH_BYTES, self._part_packets, self._kernel.now))
                self._part = self._part_packets = 0
                if queue_size is not None:
                    dropped += self._queue_last(queue_size)
        return dropped

    def wait_for_room(self, size: int) -> None:
        """Wait until the sockets have room for a message, as `publish` without a queue does.

        Args:
            size: bytes of the serialized message; 0 if they are not known.
        """
        kernel = self._kernel
        while self._bytes and self._bytes - self._read + size + LENGTH_BYTES > SOCKET_BYTES:
            if kernel.current is kernel.host:
                return
            kernel.wait_on(self._room)

    def _queue_last(self, queue_size: int) -> list[Waiting]:
        """Let the last message wait in its publisher's queue if the sockets are full; return the packets that the
        queue drops.
        """
        self._queue_holds(self._queued + 1)
        if not queue_size or self._queued <= queue_size:
            return []
        at = len(self._messages) - self._queued
        start = sum(each.packets for each in islice(self._messages, at))
        message = self._messages[at]
        del self._messages[at]
        self._queued -= 1
        self._bytes -= message.size
        self._packets.rotate(-start)
        dropped = self._pop(message.packets)
        self._packets.rotate(start)
        return dropped

    def _queue_holds(self, count: int) -> None:
        """Set the number of messages in the publisher's queue.

        Its thread takes all of them when it has written those that it took before.
        """
        self._queued = count if count < self._outside() else 0

    def _outside(self) -> int:
        """Return the number of messages for which the sockets have no room."""
        if self._bytes - self._read <= SOCKET_BYTES:
            return 0
        ends = accumulate(each.size for each in self._messages)
        return sum(end - self._read > SOCKET_BYTES for end in ends)

    # -- the subscriber's side -----------------------------------------------------------------------------------------

    def read(self, buff_size: int, queue_size: int | None) -> list[Waiting]:
        """Read at least one message, unless there is none, or some are left from the last time.

        Args:
            buff_size: bytes of one read.
            queue_size: messages that are kept; None for all.

        Returns:
            The packets of the older messages, which are dropped.
        """
        if self._ahead or not self._messages:
            return []
        missing = self._messages[0].size - self._read
        self._read = min(self._read + -(-missing // buff_size) * buff_size, self._bytes)
        count = sum(end <= self._read for end in accumulate(each.size for each in self._messages))
        self._ahead = count if queue_size is None else min(count, queue_size)
        dropped: list[Waiting] = []
        for _ in range(count - self._ahead):
            dropped += self._pop(self._forget().packets)
        self.leaves_newer = len(self._messages) > self._ahead
        self._queue_holds(self._queued)
        self.wake()
        return dropped

    def take(self) -> tuple[list[Waiting], int]:
        """Take the next message that was read. Returns its packets, and the time in ns for which it waited.

        If none is whole, these are the packets that there are, and 0.
        """
        late_ns, count = 0, len(self._packets)
        if self._messages:
            self._ahead -= 1
            message = self._forget()
            late_ns, count = self._kernel.now - message.at_ns, message.packets
        else:
            self._bytes = self._read = self._part = self._part_packets = 0
        packets = self._pop(count)
        if packets:
            self._taken = packets[0][1]
            self._taken_until = self._taken.gets + count
        return packets, late_ns

    def wake(self) -> None:
        """Let publishers look for room again."""
        if self._room:
            self._kernel.wake_all(self._room)

    def _forget(self) -> _Message:
        """Remove the first message from the counts."""
        message = self._messages.popleft()
        self._bytes -= message.size
        self._read = max(0, self._read - message.size)
        return message

    def _pop(self, count: int) -> list[Waiting]:
        return [self._packets.popleft() for _ in range(count)]


@dataclass(slots=True)
class Lag:
    """A subscription that handles old messages although newer ones wait, in the words of a run's report.

    Attributes:
        topic, node: its names.
        queue_size, buff_size: of the subscription.
        size: bytes of the longest message.
        worst_ns: the longest time from a message's publication until its callback.
        held_up: publishers that had to wait in `publish`.
    """

    topic: str
    node: str
    queue_size: int
    buff_size: int
    size: int = 0
    worst_ns: int = 0
    held_up: tuple[str, ...] = ()

    def __str__(self) -> str:
        """Return a line for the report of a run."""
        held = f"; publish() of {' and '.join(self.held_up)} waits for it" if self.held_up else ""
        return (
            f"{self.topic}: {self.node} handles messages up to {self.worst_ns / NS_PER_S:.1f} s late although newer "
            f"ones wait{held}: queue_size={self.queue_size} drops only among the {self.buff_size:,} bytes (buff_size) "
            f"of one read, and a message has {self.size:,} bytes; subscribe with buff_size={CURE}, as ROS needs it"
        )
