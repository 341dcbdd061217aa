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
from rclpy_shim.seam.topic_events import Deadline, Incompatible, LivelinessChanged, LivelinessLost, Matched, Status
from rclpy_shim.seam.waiting import WaitingNode
from rospy_shim.client import connection_setup as connecting
from rospy_shim.client.link import Link
from rospy_shim.client.subscription import NO_LIMIT, POLL, WHOLE, Subscription
from rospy_shim.types.transport import EVERYBODY, HEADER_BYTES, SPARE_AT, is_for_another

if TYPE_CHECKING:
    from collections.abc import Callable, Sized

    from rospy_shim.graph.graph import Header, TopicEntry

STAMP = slice(6, 12)  # the spacecraft time in a packet, in units of 2**-16 s


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
        self._kept: deque[tuple[int, bytes]] = deque(maxlen=quality.depth)  # with the time in ns
        note, now = program.waiting.note_change, program.steady_ns
        self.matched, self.incompatible = Matched(note), Incompatible(note)
        self.deadline = Deadline(note, quality.deadline_ns, now)
        self.lost = LivelinessLost(note, quality.lease_ns, now)
        self._is_watched = bool(quality.deadline_ns or quality.is_manual)
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
        note_matches(topic)

    def close(self) -> None:
        """Leave the graph."""
        topic = self.topic
        super().close()
        note_matches(topic)

    def peer_connected(self, subscription: Subscription) -> None:
        """Count an expected subscriber as connected."""
        super().peer_connected(subscription)
        note_matches(self.topic)

    def assert_liveliness(self) -> None:
        """Say that the publisher is alive (rcl_publisher_assert_liveliness)."""
        if self.quality.is_manual:
            self.lost.note()
            for each in self.topic.subscriptions if self.topic is not None else ():
                if isinstance(each, TopicReader):
                    each.program.waiting.look_again()

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
        if self._is_watched:
            self.deadline.note()
            self.assert_liveliness()
        if self._counts_header:
            message.header._seq = self.seq
        payload: bytes = self._pack(message)
        if self.is_latch:
            self._kept.append((self.node.kernel.now, payload))
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
        span, now = self.quality.lifespan_ns, self.node.kernel.now
        kept = [payload for at, payload in self._kept if not span or now - at < span]
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
        note, now = program.waiting.note_change, program.steady_ns
        self.matched, self.incompatible = Matched(note), Incompatible(note)
        self.message_lost = Status(("total_count",), note)
        self.deadline = Deadline(note, quality.deadline_ns, now, self.ready)
        self.liveliness = LivelinessChanged(note, self._publishers)
        self._drops_old = False  # a publisher has a lifespan

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
        note_matches(topic)

    def _publishers(self) -> dict[Link, LivelinessLost | None]:
        """Return the connected publishers; for those that must say that they are alive, with their losses."""
        links = self.peers if self.topic is not None else []
        return {each: each.lost if isinstance(each, TopicWriter) and each.quality.is_manual else None for each in links}

    def note_publishers(self) -> None:
        """Note a change of the connected publishers."""
        self.matched.note(self.count())
        self._drops_old = any(isinstance(each, TopicWriter) and each.quality.lifespan_ns for each in self.peers)

    def _is_old(self, packet: bytes) -> bool:
        """Return True if a message has expired, by its publisher's lifespan."""
        header = None if self.topic is None else self.topic.sender_of(packet)
        spans = [
            each.quality.lifespan_ns for each in self.peers if isinstance(each, TopicWriter) and each.header is header
        ]
        if not spans or not spans[0]:
            return False
        age = self._bus.ports.time.stamp() - int.from_bytes(packet[STAMP], "big")
        return bool(age * 1_000_000_000 >> 16 >= spans[0])

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
            if self._drops_old and self._is_old(packet):
                continue
            message = self._made(packet, HEADER_BYTES)
            if message is not None:
                if self.quality.deadline_ns:
                    self.deadline.note()
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
            note_matches(topic)

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
    """Keep two sides apart whose qualities of service do not match, and let both count it.

    Returns:
        True if they do not match.
    """
    policy = mismatch(link.quality, subscription.quality)
    if policy is None:
        return False
    if subscription not in link.expected:
        link.expect_peer(subscription)
        link.incompatible.note(policy)
        subscription.incompatible.note(policy)
    return True


def note_matches(topic: TopicEntry | None) -> None:
    """Let all sides of a topic count their other sides."""
    if topic is None:
        return
    for link in topic.links:
        if isinstance(link, TopicWriter):
            link.matched.note(link.count())
    for subscription in topic.subscriptions:
        if isinstance(subscription, TopicReader):
            subscription.note_publishers()
