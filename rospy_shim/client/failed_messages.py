"""Remains of a message that could not be serialized, and the connections that they corrupt.

A publisher of rospy has one buffer for all of its connections. If a field cannot be serialized, four bytes for the
length, still zero, and the preceding fields stay there, and the next good message is sent after them. A subscriber
reads an empty message and cannot convert it to its type. It connects again with the rest still in its own buffer, takes
that for a connection header, and gives up a second later (rospy.topics._PublisherImpl.publish,
rospy.impl.tcpros_base.TCPROSTransport). It connects once more when the topic's publishers change. A subscriber of any
type (AnyMsg) stays connected, and reads the bytes as they come.
"""

from __future__ import annotations

import struct
from io import BytesIO
from typing import TYPE_CHECKING, Any

from rospy_shim.client import connection_setup as connecting

if TYPE_CHECKING:
    from rospy_shim.client.link import Link
    from rospy_shim.client.subscription import Subscription

GIVES_UP_NS = 1_000_000_000  # after which a subscriber has no connection any more, and can make a new one
_LENGTH = struct.Struct("<I")
_NO_LENGTH = bytes(4)
_NOTE = (
    "cfepy: a message for {topic} could not be serialized. As on ROS, the half of it that was written stays in the"
    " publisher's buffer: the next message goes out behind it, and whoever subscribes then gets nothing any more.\n"
)


def half_of(message: Any) -> bytes:
    """Return the bytes that `serialize` writes of a message before it fails."""
    buff = BytesIO()
    try:
        message.serialize(buff)
    except Exception:  # the error that made it fail before
        pass
    return buff.getvalue()


class ByteStream:
    """Splits the bytes of a connection into messages, by the lengths in front of them.

    Args:
        octets: the bytes before the first message.
    """

    def __init__(self, octets: bytes) -> None:
        self._octets = octets

    def read(self, message: bytes) -> list[bytes]:
        """Add the bytes of one more message. Returns the messages that are complete now."""
        data = self._octets + _LENGTH.pack(len(message)) + message
        found = []
        while len(data) >= 4 and len(data) >= 4 + (size := _LENGTH.unpack_from(data)[0]):
            found.append(data[4 : 4 + size])
            data = data[4 + size :]
        self._octets = data
        return found


class Leftovers:
    """The leftovers in the buffer of a publisher, and the connections that they or an error have ended.

    Args:
        link: the publisher.
    """

    def __init__(self, link: Link) -> None:
        self._link = link
        self._octets = b""
        self._noted = False
        self._ended: dict[Subscription, int] = {}  # since when, in virtual ns
        self._streams: dict[Subscription, ByteStream] = {}

    @property
    def streams(self) -> int:
        """The number of subscriptions of any type that have lost the message boundaries."""
        return len(self._streams)

    def add(self, half: bytes) -> None:
        """Add the written part of a message that could not be serialized."""
        self._octets += _NO_LENGTH + half
        if not self._noted:
            self._noted = True
            self._link.node.universe.print_error(_NOTE.format(topic=self._link.name))

    def go_out(self, payload: bytes) -> None:
        """Send a good message to all subscriptions, after the leftovers."""
        if self._octets:
            octets, self._octets = self._octets, b""
            for each in self._link.peers:
                if each not in self._streams:
                    self._spoil(each, octets)
        for each, stream in self._streams.items():
            for found in stream.read(payload):
                each.deliver(found, self._link.header)

    def goes_to(self, subscription: Subscription, payload: bytes) -> bool:
        """Send a good message to one subscription, after the leftovers. Returns False if it does not arrive
        unchanged.
        """
        if self._octets:
            octets, self._octets = self._octets, b""
            self._spoil(subscription, octets)
        stream = self._streams.get(subscription)
        if stream is not None:
            for found in stream.read(payload):
                subscription.deliver(found, self._link.header)
        return stream is None and subscription in self._link.peers

    def _spoil(self, subscription: Subscription, octets: bytes) -> None:
        """Send leftovers to a subscription."""
        if subscription.takes_any_type:
            self._streams[subscription] = ByteStream(octets)
            subscription.ignore(self._link)
        else:
            self._end(subscription, self._link.node.kernel.now)

    def cut(self, subscription: Subscription) -> None:
        """End a connection from the publisher's side."""
        if subscription in self._link.peers:
            self._end(subscription, self._link.node.kernel.now - GIVES_UP_NS)

    def _end(self, subscription: Subscription, since: int) -> None:
        self._link.peer_left(subscription, gone=False)
        self._ended[subscription] = since
        self._link.expect_peer(subscription)

    def forget(self, subscription: Subscription) -> None:
        """Forget a subscription that is closed."""
        self._ended.pop(subscription, None)
        self._streams.pop(subscription, None)

    def reconnect(self) -> None:
        """Reconnect the subscriptions that have given up, because the topic's publishers have changed."""
        link = self._link
        due = link.node.kernel.now - GIVES_UP_NS
        for each in [each for each, since in self._ended.items() if since <= due]:
            del self._ended[each]
            link.expected.remove(each)
            each.heed(link)
            connecting.begin(link, each, connecting.delay_of(link, each), late=True)
