"""Publishers and subscriptions of ROS 2 on the topics of the mission's graph.

A publisher is a `Link` and a subscription a `Subscription` of rospy_shim, so nodes of both worlds see each other. The
differences are here: a subscription has no task, since an executor takes its messages. Its pipe has the depth of its
QoS and drops the oldest message. A publisher keeps as many messages for late subscriptions as its depth.
"""

from __future__ import annotations

from collections import deque
from typing import TYPE_CHECKING, Any

from cfepy.status import CfeError
from rclpy_shim.seam.matching import Quality, mismatch
from rclpy_shim.seam.waiting import WaitingNode
from rospy_shim.client import connection_setup as connecting
from rospy_shim.client.link import Link
from rospy_shim.client.subscription import NO_LIMIT, POLL, WHOLE, Subscription
from rospy_shim.types.transport import EVERYBODY, HEADER_BYTES, SPARE_AT, is_for_another

if TYPE_CHECKING:
    from collections.abc import Callable, Sized

    from rospy_shim.graph.graph import Header

NO_SENDING = (
    "New subscription discovered on topic '{}', requesting incompatible QoS. No messages will be sent to it."
    " Last incompatible policy: {}"
)
NO_RECEIVING = (
    "New publisher discovered on topic '{}', offering incompatible QoS. No messages will be received from it."
    " Last incompatible policy: {}"
)


class TopicWriter(Link):
    """The publishing side of a topic (rcl_publisher_t).

    Args:
        program: the program.
        name: resolved name of the topic.
        data_class: message class.
        quality: its quality of service.
        warn: logs a warning in the name of the node.
    """

    def __init__(
        self, program: WaitingNode, name: str, data_class: Any, quality: Quality, warn: Callable[[str], object]
    ) -> None:
        super().__init__(program, name, data_class)
        self.quality = quality
        self.warn = warn
        self._kept: deque[bytes] = deque(maxlen=quality.depth)
        self._counts_header = data_class._slot_types[:1] == ["std_msgs/Header"]
        self.queue_size = quality.depth
        if quality.is_kept:
            self.enable_latch()

    def connect(self) -> None:
        """Go on the graph."""
        super().connect()
        topic = self.topic
        for subscription in topic.subscriptions[:] if topic is not None else ():
            if isinstance(subscription, TopicReader):
                part_if_unequal(self, subscription)

    def serialize(self, message: Any) -> bytes:
        """Return the bytes of a message, with the next sequence number in its header for nodes of ROS 1.

        Raises:
            AssertionError, TypeError: a field holds a value that its type cannot carry.
        """
        payload = self._packed(message)
        self.message_data_sent += len(payload)
        return payload

    def _packed(self, message: Any) -> bytes:
        self.seq += 1
        if self._counts_header:
            message.header._seq = self.seq
        payload: bytes = self._pack(message)
        if self.is_latch:
            self._kept.append(payload)
        return payload

    def keep(self, message: Any) -> None:
        """Keep a message for later subscriptions without sending it."""
        self._packed(message)

    def _keep_back(self, message: Any) -> None:
        self._unsent(self._unsent_head + self._packed(message))
        if self.topic is not None:
            self.topic.unsent = True

    def give_latched(self, subscription: Subscription) -> None:
        """Give a new subscription the messages that were kept; one of ROS 1 gets the last one."""
        kept = list(self._kept)
        if not isinstance(subscription, TopicReader):
            kept = kept[-1:]
        for payload in kept:
            subscription.deliver(payload, self.header)
            if self.topic is not None:
                self.topic.latched += 1

    def count(self) -> int:
        """Return the number of matched subscriptions (rcl_publisher_get_subscription_count)."""
        return self.get_num_connections()


class TopicReader(Subscription):
    """The subscribing side of a topic (rcl_subscription_t); an executor calls `take`.

    Args:
        program: the program.
        name: resolved name of the topic.
        data_class: message class.
        quality: its quality of service.
        warn: logs a warning in the name of the node.
    """

    def __init__(
        self, program: WaitingNode, name: str, data_class: Any, quality: Quality, warn: Callable[[str], object]
    ) -> None:
        super().__init__(program, name, data_class)
        self.quality = quality
        self.warn = warn
        self.program = program
        self.queue_size = None if quality.keeps_all else quality.depth
        self._items: Sized = ()  # the packets in the pipe
        self.has_begun = quality.is_kept  # then publishers give the messages that they keep

    def connect(self) -> None:
        """Go on the graph: make the pipe and join the topic.

        Raises:
            UsageError: the topic's MsgId belongs to another topic.
            CfeError: the bus has no room for another pipe or subscription.
        """
        self.connected = True
        topic = self.topic = self.node.topic_for(self.name, self.data_class, "subscription")
        if topic is None:
            return
        bus, waiting = self._bus, self.program.waiting
        self._pipe = bus.create_pipe(self._depth(), self.node.task_name(self.name))
        self._size_pipe()
        pipe = bus.find_pipe(self._pipe)
        waiting.adopt(pipe)
        self._items = pipe.items
        delays = {link: connecting.delay_of(link, self) for link in topic.links}
        for link, delay in delays.items():
            if delay:
                self.ignore(link)
        bus.subscribe_ex(topic.msg_id, self._pipe, 0, NO_LIMIT)
        topic.add_subscription(self)
        for link in list(topic.links):
            if not (isinstance(link, TopicWriter) and part_if_unequal(link, self)):
                connecting.begin(link, self, delays.get(link, 0), late=True)

    def _size_pipe(self) -> None:
        pipe = self._find_pipe()
        if pipe is not None:
            pipe.depth, pipe.keeps_newest = self._depth(), self.queue_size is not None

    def is_welcomed_by(self, link: Link) -> None:
        """Do nothing: publishers of ROS 2 have no listeners, and connections that take time give kept messages."""

    def fall_behind(self, has_memory: bool) -> None:
        """Do nothing: messages wait in the pipe alone."""

    def expect_message(self, link: Link, size: int) -> None:
        """Do nothing: a publisher does not wait for this subscription."""

    def has_sent(self) -> None:
        """Do nothing: a long message waits in the pipe."""

    def deliver(self, payload: bytes, header: Header) -> None:
        """Give a message to this subscription alone: one that a publisher kept."""
        if not self.quality.is_kept:
            return
        super().deliver(payload, header)
        self.program.waiting.look_again()

    def _call_attention(self) -> None:
        self._attention = True

    def ready(self) -> bool:
        """Return True if a message, or a part of one, waits."""
        return bool(self._items or self._backlog)

    def take(self) -> tuple[Any, Header] | None:
        """Take the oldest message (rcl_take).

        Returns:
            The message, and the connection header of its publisher; None if no whole message waits.
        """
        while self.topic is not None:
            if self._backlog and not self._has_earlier(self._backlog[0][0]):
                _, payload, header = self._backlog.pop(0)
                return self._made(payload, 0), header
            packet = self._bus.receive_buffer(self._pipe, POLL)
            if packet is None:
                return None
            if self.topic.raw:
                return self._packet_as_message(packet, 0), {}
            if packet[SPARE_AT:HEADER_BYTES] != EVERYBODY and is_for_another(packet, self._pipe):
                continue
            if packet[2] < WHOLE:
                packet = self._assemble(packet, self.topic)
                if packet is None:
                    continue
            message = self._made(packet, HEADER_BYTES)
            if message is not None:
                return message, self.topic.sender_of(packet)
        return None

    def _made(self, packet: bytes, at: int) -> Any:
        try:
            return self._unpack(packet, at)
        except Exception as error:  # applications and the ground may send any bytes
            self.warn(f"cannot read a message on {self.name}: {error}")
            return None

    def count(self) -> int:
        """Return the number of matched publishers (rcl_subscription_get_publisher_count)."""
        if self.topic is None:
            return 0
        return len(self.peers) + len(self.topic.compiled_publishers)

    def close(self) -> None:
        """Leave the graph and delete the pipe."""
        topic, self.topic = self.topic, None
        self.closed = True
        self._items, self._backlog = (), []
        if topic is not None:
            topic.remove_subscription(self)
            topic.leave()
            self.__give_back__()

    def __give_back__(self) -> None:
        """Delete the pipe."""
        pipe = self._find_pipe()
        if pipe is not None:
            self.program.waiting.release(pipe)
            try:
                super().__give_back__()
            except CfeError:
                pass  # a task of another application closes it; ES deletes the pipe with the application


def part_if_unequal(link: TopicWriter, subscription: TopicReader) -> bool:
    """Keep two sides apart whose qualities of service do not match, and warn on both sides.

    Returns:
        True if they do not match.
    """
    policy = mismatch(link.quality, subscription.quality)
    if policy is None:
        return False
    if subscription not in link.expected:
        link.expect_peer(subscription)
        link.warn(NO_SENDING.format(link.name, policy))
        subscription.warn(NO_RECEIVING.format(link.name, policy))
    return True
