"""Nodes outside of the mission, with the interface of the two sides of a topic or a service.

They stand for programs on the computer that the run is on. Nothing here waits for them: a message for an outside
subscriber is passed on at once.
"""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from cfepy.sb import Outlet
from cfepy.status import CfeError
from rospy_shim.client.link import Link
from rospy_shim.client.subscription import Subscription
from rospy_shim.graph.compiled import CompiledService, DeclaredType
from rospy_shim.types.transport import (
    EVERYBODY,
    HEADER_BYTES,
    SPARE_AT,
    WHOLE,
    Assembler,
    is_for_another,
    segments,
    sequence_of,
    whole_header,
)

if TYPE_CHECKING:
    from cfepy.app import Cfe
    from cfepy.rtos import Kernel
    from cfepy.sb import Pipe
    from rospy_shim.graph.graph import Graph, Header, TopicEntry


class OutsideNode:
    """A node outside of the mission, with the interface that the two sides of a topic need.

    Args:
        name: its full name.
        uri: its URI.
        graph: the mission's ROS graph.
        cfe: the services.
        kernel: the kernel of the simulated computer.
    """

    call_ns = publish_slot_ns = pid = 0
    owner = None
    config = SimpleNamespace(app="host")  # the sender of its messages, for observers of the bus

    def __init__(self, name: str, uri: str, graph: Graph, cfe: Cfe, kernel: Kernel) -> None:
        self.names = SimpleNamespace(name=name)
        self.uri = uri
        self.client = SimpleNamespace(get_node_uri=lambda: self.uri)
        self.graph = graph
        self.cfe = cfe
        self.kernel = kernel

    def working(self, name: str, unpack: Any) -> Any:
        """Return `unpack` unchanged: its callbacks take none of the mission's time."""
        return unpack


class OutsideLink(Link):
    """The publishing side of an outside node: it sends the node's messages on the bus.

    Args:
        node: the publisher.
        topic: the topic, which it has joined.
        declared: type of the messages.
        latching: True if it latches.
    """

    is_outside = True

    def __init__(self, node: OutsideNode, topic: TopicEntry, declared: DeclaredType, latching: bool) -> None:
        as_node: Any = node
        as_class: Any = declared
        super().__init__(as_node, topic.name, as_class)
        self.topic = topic
        self.raw = topic.raw
        self.msg_id = topic.msg_id
        self.is_latch = latching
        self.queue_size = 1  # its messages wait outside
        self.header |= self._own_header()
        topic.add_link(self)

    def close(self) -> None:
        """Leave the graph."""
        self.closed = True
        self._routes = {}
        if self.topic is not None:
            self.topic.remove_link(self)
            self.topic.leave()
            self.topic = None

    def has_room(self, payload: bytes) -> bool:
        """Return True if the bus and every subscriber take a message now, or drop an older one for it.

        A subscriber whose queue size exceeds its pipe drops none: further messages can wait outside.
        """
        count = -(-len(payload) // self._room) or 1
        route = self._routes.get(self.msg_id)
        return route is None or (
            self._bus.has_room(payload) and all(self._takes(each.pipe, count) for each in route.active)
        )

    def _takes(self, pipe: Pipe, count: int) -> bool:
        if len(pipe.items) + count <= pipe.depth:
            return True
        drops = pipe.keeps_newest and count <= pipe.depth
        return drops and not any(each.is_cut_short(pipe) for each in self.peers)

    def enter(self, payload: bytes) -> bool:
        """Enter a message. Returns False if the bus did not take it."""
        self.seq += 1
        self.message_data_sent += len(payload)
        if self.is_latch:
            self.latch = payload
        route = self._routes.get(self.msg_id)
        if self.topic is None or route is None or not route.active:
            return True
        try:
            packets = self._packets(payload)
            if self.raw and int.from_bytes(packets[0][:2], "big") != self.msg_id:
                return False
            for index, packet in enumerate(packets):
                self._note(index)
                self._bus.transmit_msg(packet)
        except CfeError:
            return False
        return True

    def _packets(self, payload: bytes) -> list[bytes]:
        if self.raw:
            return [payload[12:]]  # behind the fields of an empty layout and the length of the data
        if len(payload) <= self._room:
            return [whole_header(self.msg_id) + payload]
        packets = list(segments(self.msg_id, payload, self._room))
        for subscription in self.peers:
            subscription.expect_segments(len(packets))
        return packets

    def serialize(self, message: Any) -> bytes:
        """Return a latched message, which is kept serialised."""
        return bytes(message)

    def give_latched(self, subscription: Subscription) -> None:
        """Give the latched message to a subscriber of the mission; another outside node gets it from the publisher
        itself.
        """
        if self.is_latch and self.latch is not None and not self.raw and not subscription.is_outside:
            subscription.deliver(self.latch, self.header)
            if self.topic is not None:
                self.topic.latched += 1


class OutsideSubscription(Subscription):
    """The subscribing side of an outside node: it passes its messages to the outside.

    Args:
        node: the subscriber.
        topic: the topic, which it has joined.
        declared: type that it wants.
        outsiders: returns True if a message comes from an outside node that has sent it to this one already.
        out: takes publisher and message.
    """

    is_outside = connects_itself = True

    def __init__(
        self,
        node: OutsideNode,
        topic: TopicEntry,
        declared: DeclaredType,
        outsiders: Callable[[], bool],
        out: Callable[[str, bytes], object],
    ) -> None:
        as_node: Any = node
        as_class: Any = declared
        super().__init__(as_node, topic.name, as_class)
        self.topic = topic
        self.has_begun = True
        self.publishers: list[str] = []  # to which it is connected
        self._outsiders = outsiders
        self._out = out
        self._raw = topic.raw
        self._together = Assembler()
        self._outlet = Outlet(node.cfe.sb, topic.msg_id, f"{node.names.name}{topic.name}", self._take)
        topic.add_subscription(self)
        topic.tell_came(node.cfe.sb, self._outlet.pipe_id)

    def expect_segments(self, count: int) -> None:
        """Do nothing: there is no queue here."""

    def ignore(self, link: Link) -> None:
        self._outlet.ignore(link.node.owner)

    def heed(self, link: Link) -> None:
        self._outlet.heed(link.node.owner)

    def deliver(self, payload: bytes, header: Header) -> None:
        self._out(header["callerid"], payload)

    def close(self) -> None:
        """Leave the graph."""
        if self.topic is not None:
            self.topic.remove_subscription(self)
            self.topic.leave()
            self.topic.tell_left(self.node.cfe.sb, self._outlet.pipe_id)
            self.topic = None
            self._outlet.close()

    def _take(self, packet: bytes) -> None:
        topic = self.topic
        if topic is None or self._outsiders():
            return
        if self._raw:
            self._out(topic.sender_of(packet)["callerid"], bytes(8) + len(packet).to_bytes(4, "little") + packet)
            return
        if packet[SPARE_AT:HEADER_BYTES] != EVERYBODY and is_for_another(packet, self._outlet.pipe_id):
            return
        whole: bytes | None = packet
        if packet[2] < WHOLE:
            header, index = topic.notes.get(sequence_of(packet), (None, None))
            whole = self._together.add(packet, header["callerid"] if header is not None else "", index)
        if whole is not None:
            self._out(topic.sender_of(packet)["callerid"], whole[HEADER_BYTES:])


class OutsideService(CompiledService):
    """A service that an outside node offers.

    Args:
        node: the node.
        name: resolved name of the service.
        declared: its type.
        uri: its URI, rosrpc://HOST:PORT.
        open_outlet: makes the outlet for its requests; a service without calls needs no MsgId.
    """

    def __init__(
        self,
        node: OutsideNode,
        name: str,
        declared: DeclaredType,
        uri: str,
        open_outlet: Callable[[], Outlet],
    ) -> None:
        as_node: Any = node
        super().__init__(as_node, name, declared)
        self.uri = uri
        self._open = open_outlet
        self._outlet: Outlet | None = None

    def __has_room__(self, packet: bytes) -> bool:
        """Return True: a request is passed on at once."""
        if self._outlet is None:
            self._outlet = self._open()
        return True

    def close(self) -> None:
        """Stop taking calls."""
        if self._outlet is not None:
            self._outlet.close()
