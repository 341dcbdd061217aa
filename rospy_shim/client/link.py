"""`Link`: the publishing side of one node on one topic, shared by all of its handles (CFE_SB_TransmitMsg).

The hot path is `Link.send`: one serialisation, one call of the bus. A message that does not fit in a packet is sent in
segments. A message without a subscriber goes into the trace alone, without virtual time or sequence number. In a run
that is recorded the link is a `TappedLink`, which shows such messages to the recorder as well.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from cfepy.status import CfeError
from cfepy.trace import UNSENT
from rospy_shim.client import connection_setup as connecting
from rospy_shim.client.failed_messages import Leftovers, half_of
from rospy_shim.client.message import packer, serialized
from rospy_shim.client.topic_side import OUTBOUND, TopicConnection, TopicSide, bus_of
from rospy_shim.types.exceptions import ROSException, ROSSerializationException
from rospy_shim.types.genpy import SerializationError
from rospy_shim.types.transport import HEADER_BYTES, segments, whole_header

if TYPE_CHECKING:
    from collections.abc import Callable

    from cfepy.sb import Route
    from rospy_shim.client.node import Node
    from rospy_shim.client.subscription import Subscription
    from rospy_shim.graph.compiled import CompiledNode
    from rospy_shim.graph.graph import Header
    from rospy_shim.types.msgs import MessageClass

PACE_NS = 100_000  # period of looking for room for the next segment in pipes of cFE applications
PATIENCE = 100  # looks, before a segment is sent to a full queue and lost there
_EMPTY_LAYOUT = 12  # bytes of a UInt8MultiArray before its data: an empty layout, and the length


class SubscribeListener:
    """Base class of listeners for the subscribers of a publisher (rospy.SubscribeListener)."""

    __module__ = "rospy.topics"

    def peer_subscribe(self, topic_name: str, topic_publish: Callable[..., None], peer_publish: Any) -> None:
        """Take a new subscriber; `topic_publish` sends a message to all, `peer_publish` to the new one only."""

    def peer_unsubscribe(self, topic_name: str, num_peers: int) -> None:
        """Take the loss of a subscriber; `num_peers` remain."""


class Link(TopicSide):
    """The publishing side of one node on one topic (rospy.topics._PublisherImpl).

    Args:
        node: the node.
        name: resolved name of the topic.
        data_class: message class.
    """

    def __init__(self, node: Node, name: str, data_class: MessageClass) -> None:
        super().__init__(node, name, data_class)
        self.has_header = bool(getattr(data_class, "_has_header", False))
        self._pack = packer(data_class)
        self.seq = 0
        self.message_data_sent = 0  # bytes
        self.queue_size: int | None = None  # messages that wait while sockets are full; None waits in `publish`
        self.is_latch = False
        self.latch: Any = None  # the last message
        self.subscriber_listeners: list[SubscribeListener] = []
        self.header: Header = {}
        self.shared = False  # with publishers of other nodes
        self.raw = False
        self.connected = False
        self.expected: list[Subscription] = []  # subscriptions whose connection still takes some time
        self.msg_id = 0
        bus = self._bus
        self._routes: dict[int, Route] = bus.routes
        self._transmit = bus.transmit_msg
        self._head = b""
        self._unsent_head = UNSENT + name.encode() + b"\0"
        self._unsent: Callable[[bytes], object] = bus.unsent
        self._charge = node.kernel.charge
        self._call_ns = node.call_ns
        self._count_items = getattr(data_class, "__count_items__", None) if node.call_ns else None
        self._slot_ns = node.publish_slot_ns
        self._slot = -1  # the slot of the last message
        self._is_gated = bool(self._slot_ns)
        self.leftovers: Leftovers | None = None  # set once a connection was corrupted
        self._room = bus.config.sb_max_msg_size - HEADER_BYTES

    def connect(self) -> None:
        """Go on the graph when the node is initialised.

        Raises:
            UsageError: the topic's MsgId belongs to another topic.
        """
        self.connected = True
        self.header |= self._own_header()
        topic = self.node.topic_for(self.name, self.data_class, "publication")
        if topic is None:
            self._routes = {}
            return
        self.topic = topic
        self.raw = topic.raw
        self.msg_id = topic.msg_id
        self._head = whole_header(topic.msg_id)
        topic.add_link(self)
        self.refresh_gate()
        for subscription in topic.subscriptions[:]:
            connecting.begin(self, subscription, connecting.delay_of(self, subscription), late=False)

    def _own_header(self) -> Header:
        return {
            "callerid": self.node.names.name,
            "latching": "1" if self.is_latch else "0",
            "md5sum": self.data_class._md5sum,
            "message_definition": getattr(self.data_class, "_full_text", ""),
            "topic": self.name,
            "type": self.data_class._type,
        }

    def enable_latch(self) -> None:
        """Keep the last message for later subscribers."""
        self.is_latch = True
        self.header["latching"] = "1"
        if self.topic is not None:
            self.topic.latching = True

    def add_subscriber_listener(self, listener: SubscribeListener) -> None:
        """Add a listener for new and lost subscribers."""
        self.subscriber_listeners.append(listener)

    def close(self) -> None:
        """Leave the graph; messages that are published later reach no subscriber."""
        self.closed = True
        self._routes = {}
        for subscription in self.expected:
            subscription.heed(self)
        self.expected = []
        if self.node.links.get(self.name) is self:
            del self.node.links[self.name]
        if self.topic is not None:
            self.topic.remove_link(self)
            self.topic.leave()
            self.topic = None

    def get_num_connections(self) -> int:
        """Return the number of pipes that get the topic's messages: subscribing nodes, and cFE applications."""
        route = self._routes.get(self.msg_id)
        if route is None or not (self.expected or self.leftovers):
            return len(route.active) if route is not None else 0
        streams = self.leftovers.streams if self.leftovers is not None else 0
        return streams + sum(self.node.owner not in each.pipe.unheard for each in route.active)

    @property
    def peers(self) -> list[Subscription]:
        """The subscribing sides that are connected."""
        subscriptions = self.topic.subscriptions if self.topic is not None else []
        return [each for each in subscriptions if each not in self.expected]

    @property
    def connections(self) -> list[TopicConnection]:
        """The connections to subscribing nodes."""
        compiled = self.topic.compiled_subscribers if self.topic is not None else []
        peers: list[Node | CompiledNode] = [*(each.node for each in self.peers), *compiled]
        return [self.connection(node, OUTBOUND) for node in peers]

    def get_stats(self) -> tuple[str, int, list[tuple[int, int, int, bool]]]:
        """Return the data of getBusStats: topic, bytes, and for each connection number, bytes, messages, state."""
        sent = self.message_data_sent
        return self.name, sent, [(each.id, sent, self.seq, True) for each in self.connections]

    def publish(self, message: Any, connection_override: Subscription | None = None) -> None:
        """Publish a message as rospy's own code does, without a check of its type.

        Args:
            message: any message.
            connection_override: the only subscription that gets it, or None for all.

        Raises:
            ROSException: the topic is closed.
            ROSSerializationException: a field holds a value that its type cannot carry.
            AttributeError: it is not a message.
        """
        if self.closed:
            raise ROSException("publish() to a closed topic")
        if connection_override is None:
            self.send(message)
            return
        if self.is_latch:
            self.latch = message
        if connection_override in self.peers:
            payload = self.serialize(message)
            is_again = connection_override.is_outside and message is self.latch  # an observer leaves no trace
            if not is_again:
                self._unsent(self._unsent_head + payload)  # the bus does not carry it
            if self.leftovers is None or self.leftovers.goes_to(connection_override, payload):
                connection_override.deliver(payload, self.header)

    def send(self, message: Any) -> None:
        """Publish a message.

        Raises:
            ROSSerializationException: a field holds a value that its type cannot carry.
        """
        if self._call_ns:
            self._charge(self._call_ns)
        if self.is_latch:
            self.latch = message
        route = self._routes.get(self.msg_id)
        if route is None or not route.active or (self.expected and not self.get_num_connections()):
            self._keep_back(message)
            return
        if self._is_gated:
            self._wait_before_sending()
        payload = self.serialize(message)
        if self.leftovers is not None:
            self.leftovers.go_out(payload)
        if self._count_items is not None:
            self._charge(self._call_ns * self._count_items(message))
        try:
            if self.raw:
                self._send_packet(message, payload)
            elif len(payload) > self._room:
                self._send_segments(payload)
            else:
                if self.shared:
                    self._note(0)
                self._transmit(self._head + payload)
        except CfeError as error:
            self.node.logs.logerr("publish on %s: %s", self.name, error)

    def _keep_back(self, message: Any) -> None:
        """Record a message without a subscriber. As in rospy, a field that its type cannot carry is not an error
        then.
        """
        try:
            payload = self._pack(message)
        except Exception:  # a generated class may raise any error
            payload = half_of(message)
        self._unsent(self._unsent_head + payload)
        if self.topic is not None:
            self.topic.unsent = True

    def refresh_gate(self) -> None:
        """Check whether messages may have to wait before they are sent."""
        self._is_gated = bool(self._slot_ns or (self.topic is not None and self.topic.lagging))

    def _wait_before_sending(self) -> None:
        if self._slot_ns:
            self._hold_back()
        if self.topic is not None and self.queue_size is None:
            for subscription in self.topic.lagging[:]:
                subscription.expect_message(self, 0)

    def _hold_back(self) -> None:
        """Wait for a time slot in which nothing was sent yet, on a board with a maximum publishing rate."""
        kernel = self.node.kernel
        slot = kernel.now // self._slot_ns
        while slot <= self._slot:
            if self.topic is not None:
                self.topic.held_back += 1
            kernel.delay((self._slot + 1) * self._slot_ns - kernel.now)
            slot = kernel.now // self._slot_ns
        self._slot = slot

    def serialize(self, message: Any) -> bytes:
        """Return the bytes of a message, with the next sequence number in its header.

        Raises:
            ROSSerializationException: a field holds a value that its type cannot carry.
        """
        self.seq = seq = self.seq + 1
        try:
            if self.has_header:
                header = message.header
                header.seq = seq
                if header.frame_id is None:
                    header.frame_id = "0"
            payload = self._pack(message)
        except Exception as error:
            payload = self._serialize_another(message, error)
        self.message_data_sent += len(payload)
        return payload

    def _serialize_another(self, message: Any, error: Exception) -> bytes:
        """Serialize a message of another type than the topic's; for one of the topic's type, keep the remains and
        raise.
        """
        if not isinstance(message, self.data_class):
            try:
                return serialized(message)
            except Exception as another:
                error = another
        self._spoilt().add(half_of(message))
        if isinstance(error, SerializationError):
            raise ROSSerializationException(str(error)) from error
        raise error

    def _spoilt(self) -> Leftovers:
        if self.leftovers is None:
            self.leftovers = Leftovers(self)
        return self.leftovers

    def _send_packet(self, message: Any, payload: bytes) -> None:
        """Send the message's data as a whole packet on a raw topic; a serialized message has them in `payload`."""
        packet = bytes(message.data) if hasattr(message, "layout") else payload[_EMPTY_LAYOUT:]
        msg_id = int.from_bytes(packet[:2], "big")
        if msg_id != self.msg_id:
            raise ROSSerializationException(
                f"{self.name} carries packets of MsgId 0x{self.msg_id:04X}, and these bytes begin with 0x{msg_id:04X}"
            )
        self._bus.transmit_msg(packet)

    def _send_segments(self, payload: bytes) -> None:
        """Send one long message.

        Subscribers that are behind get it through their sockets; for a full pipe of an application, the caller waits.
        """
        count = -(-len(payload) // self._room)
        peers = [each for each in self.peers if not each.is_outside]
        for subscription in peers:
            subscription.expect_segments(count)
        self.acquire()
        try:
            for subscription in peers:
                subscription.expect_message(self, len(payload))
            for index, packet in enumerate(segments(self.msg_id, payload, self._room)):
                self._wait_for_room(packet, peers)
                self._note(index)
                self._bus.transmit_msg(packet)
            for subscription in peers:
                subscription.has_sent()
        finally:
            self.release()

    def _note(self, index: int) -> None:
        """Note the sender of the next packet of the topic, since a packet does not contain it."""
        route = self._routes.get(self.msg_id)
        if self.topic is not None and route is not None:
            self.topic.notes[(route.sequence + 1) & 0x3FFF] = (self.header, index)

    def _wait_for_room(self, packet: bytes, peers: list[Subscription]) -> None:
        """Make room for a packet.

        Args:
            packet: the packet.
            peers: subscriptions of nodes in Python, whose messages can wait in sockets; applications get time.
        """
        if self._has_room(packet):
            return
        kernel = self.node.kernel
        kernel.yield_cpu()
        if self._has_room(packet):
            return
        for subscription in peers:
            subscription.fall_behind(self._bus.has_room(packet))
        for _ in range(PATIENCE):
            if self._has_room(packet):
                return
            kernel.delay(PACE_NS)

    def _has_room(self, packet: bytes) -> bool:
        """Return True if the bus and every pipe take a packet."""
        route = self._routes.get(self.msg_id)
        return route is None or (
            self._bus.has_room(packet)
            and all(
                (each.puts - each.gets < each.limit and len(each.pipe.items) < each.pipe.depth)
                or self.node.owner in each.pipe.unheard
                for each in route.active
            )
        )

    # -- new and lost subscribers --------------------------------------------------------------------------------------

    def give_latched(self, subscription: Subscription) -> None:
        """Give a new subscriber the latched message, if there is one. A message that cannot be sent ends the
        connection.
        """
        if self.is_latch and self.latch is not None and not self.raw:
            try:
                self.publish(self.latch, subscription)
            except Exception as error:  # serializing may raise any error
                self._refuse(subscription, error)
                return
            if self.topic is not None:
                self.topic.latched += 1

    def expect_peer(self, subscription: Subscription) -> None:
        """Expect a subscriber that is about to connect; until then published messages do not reach it."""
        self.expected.append(subscription)
        subscription.ignore(self)

    def peer_connected(self, subscription: Subscription) -> None:
        """Count an expected subscriber as connected."""
        self.expected.remove(subscription)
        subscription.heed(self)

    def peer_joined(self, subscription: Subscription, *, late: bool = False) -> None:
        """Notify the listeners of a new subscriber, which is connected at once.

        Args:
            subscription: the new one.
            late: the publisher existed before it: a latched message follows the messages of the listeners.
        """
        if self.subscriber_listeners:
            if late:
                subscription.is_welcomed_by(self)
            self.node.start_task(self.name, lambda: self.welcome(subscription, late=late))
        elif late and subscription.has_begun:
            self.give_latched(subscription)

    def welcome(self, subscription: Subscription, *, late: bool) -> None:
        """Set up a new connection as rospy does, in the one thread of a node that accepts connections.

        Args:
            subscription: the new one.
            late: it gets the latched message.
        """

        def peer_publish(data: Any) -> None:
            self.publish(data, subscription)

        self.node.takes_connections.take()
        try:
            for listener in self.subscriber_listeners[:]:
                listener.peer_subscribe(self.name, self.publish, peer_publish)
            if late:
                self.give_latched(subscription)
        except Exception as error:  # a listener may raise any error
            self._refuse(subscription, error)
        finally:
            self.node.takes_connections.give()

    def _refuse(self, subscription: Subscription, error: Exception) -> None:
        """Close a connection that could not be set up."""
        self.node.logs.logwarn("Inbound TCP/IP connection failed: %s", error)
        self._spoilt().cut(subscription)

    def peer_left(self, subscription: Subscription, *, gone: bool = True) -> None:
        """Notify the listeners, unless it was not connected.

        Args:
            subscription: the lost one.
            gone: it is closed; False if it has only lost its connection.
        """
        if self.leftovers is not None:
            self.leftovers.forget(subscription)
        if subscription in self.expected:
            self.expected.remove(subscription)
            return
        remaining = len(self.peers) - (not gone)
        for listener in self.subscriber_listeners:
            body = lambda each=listener: each.peer_unsubscribe(self.name, remaining)  # noqa: E731
            self.node.start_task(self.name, body)


class TappedLink(Link):
    """A link that shows messages without a subscriber to `on_unsent` of the bus."""

    def __init__(self, node: Node, name: str, data_class: MessageClass) -> None:
        super().__init__(node, name, data_class)
        on_unsent: Any = bus_of(node).on_unsent  # a static method, which binds no bus
        self._on_unsent: Callable[[Link, bytes], object] | None = on_unsent

    def send(self, message: Any) -> None:
        if self.topic is not None and self._on_unsent is not None and not self.get_num_connections():
            try:
                self._on_unsent(self, self._pack(message))
            except Exception:  # a generated class may raise any error
                pass  # as in `Link.send`, which does not check a message without a subscriber
        super().send(message)


def link_class(node: Node) -> type[Link]:
    """Return the class of a node's links."""
    return Link if bus_of(node).on_unsent is None else TappedLink
