"""`rospy.Subscriber`: from a packet in a pipe to a node's callbacks.

`Subscription` is what all handles of a node on one topic share: one pipe and one child task, which calls the callbacks
in the order in which they were registered, all with the same message object, as rospy's receiving thread does. A pipe
that is full loses the newest message, and the bus reports it. May import cfepy.nodes, cfepy.rtos and
cfepy.status.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from cfepy.nodes.report import traceback_text
from cfepy.rtos import TIMEOUT
from cfepy.status import CfeError
from rospy_shim.exceptions import ROSException
from rospy_shim.message import unpacker
from rospy_shim.topic_handle import Connection, TopicHandle, connections_of
from rospy_shim.transport import HEADER_BYTES, Assembler, sequence_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from rospy_shim.graph import Header, Topic
    from rospy_shim.node import Node

DEFAULT_BUFF_SIZE = 65536
WHOLE = 0xC0
NO_PIPE = -1


class Subscription:
    """The subscribing side of one node on one topic.

    Args:
        node: the node.
        name: resolved name of the topic.
        data_class: message class.
        depth: messages that may wait; None is as many as the platform allows.
    """

    def __init__(self, node: Node, name: str, data_class: Any, depth: int | None) -> None:
        self.node = node
        self.name = name
        self.data_class = data_class
        self._unpack = unpacker(data_class)
        self.depth = depth
        self.handles = 0
        self.callbacks: tuple[tuple[Callable[..., Any], Any], ...] = ()
        self.connected = False
        self.latest: Any = None  # kept while a latching publisher is there
        self._backlog: list[tuple[bytes, Header]] = []
        self._attention = False  # something is to be done beside receiving
        self._closed = False
        self._pipe = NO_PIPE
        self._assembler = Assembler()
        self.topic: Topic | None = None

    def add_callback(self, callback: Callable[..., Any], argument: Any) -> None:
        """Call this too, at once with a latched message that has come already."""
        self.callbacks = (*self.callbacks, (callback, argument))
        if self.latest is not None:
            self._call(callback, argument, self.latest)

    def remove_callback(self, callback: Callable[..., Any], argument: Any) -> None:
        """Do not call this any more."""
        kept = list(self.callbacks)
        kept.remove((callback, argument))
        self.callbacks = tuple(kept)

    def connect(self) -> None:
        """The node is initialised: go on the graph.

        Raises:
            UsageError: the topic's MsgId belongs to another topic.
        """
        self.connected = True
        topic = self.topic = self.node.topic_for(self.name, self.data_class)
        if topic is not None:
            self.node.start_child(self.name, lambda: self._serve(topic))

    def close(self) -> None:
        """Leave the graph. The task that serves it ends when it is back from its callbacks."""
        self._closed = True
        self.node.subscriptions.pop(self.name, None)
        if self.topic is not None:
            self.topic.remove_subscription(self)
            self.topic.leave()
            if self._pipe != NO_PIPE:
                self.node.cfe.sb.unsubscribe(self.topic.msg_id, self._pipe)
            self.topic = None
        self._call_attention()

    def get_num_connections(self) -> int:
        """How many nodes publish the topic."""
        return len(self.topic.links) if self.topic is not None and self in self.topic.subscriptions else 0

    def has_connection(self, endpoint_id: str) -> bool:
        """Whether the node of that name publishes."""
        return any(each.endpoint_id == endpoint_id for each in self.connections)

    @property
    def connections(self) -> list[Connection]:
        """The nodes that publish."""
        return connections_of(self.topic.links) if self.topic is not None else []

    def deliver(self, payload: bytes, header: Header) -> None:
        """Give this subscriber alone a message: a latched one, or one of a SubscribeListener."""
        self._backlog.append((payload, header))
        self._call_attention()

    def _call_attention(self) -> None:
        self._attention = True
        pipe = self.node.cfe.sb.find_pipe(self._pipe) if self._pipe != NO_PIPE else None
        if pipe is not None:
            self.node.kernel.wake_all(pipe.waits, TIMEOUT)

    # -- in the task -------------------------------------------------------------------------------------------------

    def _serve(self, topic: Topic) -> None:
        if self._closed:
            return
        self._open(topic)
        try:
            self._receive(topic)
        except CfeError as error:
            if self._pipe != NO_PIPE:
                self.node.logs.logerr("subscription of %s ends: %s", self.name, error)
        finally:
            self.release()

    def _open(self, topic: Topic) -> None:
        """Make the pipe, join the topic, and take what publishers have latched."""
        bus = self.node.cfe.sb
        most = bus.config.os_queue_max_depth
        depth = most if self.depth is None else min(self.depth, most)
        self._pipe = bus.create_pipe(depth, self.node.kernel.current.name)
        bus.subscribe_ex(topic.msg_id, self._pipe, 0, depth)
        topic.add_subscription(self)
        for link in list(topic.links):
            link.peer_joined(self)

    def release(self) -> None:
        """Give the pipe back."""
        pipe, self._pipe = self._pipe, NO_PIPE
        if pipe != NO_PIPE and self.node.cfe.sb.find_pipe(pipe) is not None:
            self.node.cfe.sb.delete_pipe(pipe)

    def _receive(self, topic: Topic) -> None:
        """Packet after packet; the loop that every received message passes through."""
        receive, pipe = self.node.cfe.sb.receive_buffer, self._pipe
        unpack = self._unpack if not topic.raw else self._packet_as_message
        while True:
            if self._attention and not self._attend():
                return
            packet = receive(pipe)
            if packet is None:
                continue
            if packet[2] < WHOLE and not topic.raw:
                packet = self._assemble(packet, topic)
                if packet is None:
                    continue
            try:
                message = unpack(packet, HEADER_BYTES)
            except Exception as error:
                self.node.logs.logerr("cannot read a message on %s: %s", self.name, error)
                continue
            message._connection_header = topic.header or topic.sender_of(packet)
            if topic.latching:
                self.latest = message
            for callback, argument in self.callbacks:
                try:
                    if argument is None:
                        callback(message)
                    else:
                        callback(message, argument)
                except Exception as error:
                    self._bad_callback(callback, error)

    def _attend(self) -> bool:
        """Do what is to be done beside receiving; False when it is to end."""
        self._attention = False
        while self._backlog and not self._closed:
            payload, header = self._backlog.pop(0)
            message = self._unpack(payload, 0)
            message._connection_header = header
            if header.get("latching") == "1":
                self.latest = message
            for callback, argument in self.callbacks:
                self._call(callback, argument, message)
        return not self._closed

    def _assemble(self, packet: bytes, topic: Topic) -> bytes | None:
        header, index = topic.notes.get(sequence_of(packet), (None, None))
        before = self._assembler.lost
        whole = self._assembler.add(packet, header["callerid"] if header is not None else "", index)
        topic.lost += self._assembler.lost - before
        return whole

    def _packet_as_message(self, packet: bytes, at: int) -> Any:
        """A raw topic: the message's data are the whole packet."""
        message = self.data_class()
        message.data = packet
        return message

    def _call(self, callback: Callable[..., Any], argument: Any, message: Any) -> None:
        try:
            if argument is None:
                callback(message)
            else:
                callback(message, argument)
        except Exception as error:
            self._bad_callback(callback, error)

    def _bad_callback(self, callback: Callable[..., Any], error: Exception) -> None:
        """An exception in a callback is logged, and the next message comes all the same."""
        where = error.__traceback__
        text = traceback_text(error.with_traceback(where.tb_next if where is not None else None))
        self.node.logs.logerr("bad callback: %s\n%s", callback, text)


class Subscriber(TopicHandle):
    """A node's handle on a topic that it subscribes to; each node has a subclass that knows the node."""

    __module__ = "rospy.topics"
    impl: Subscription | None

    def __init__(
        self,
        name: str,
        data_class: Any,
        callback: Callable[..., Any] | None = None,
        callback_args: Any = None,
        queue_size: int | None = None,
        buff_size: int = DEFAULT_BUFF_SIZE,
        tcp_nodelay: bool = False,
    ) -> None:
        """Subscribe to a topic.

        Args:
            name: of the topic.
            data_class: message class, or AnyMsg.
            callback: takes the message, and `callback_args` unless that is None.
            callback_args: second argument of the callback.
            queue_size: messages that may wait; None is as many as the platform allows. The first subscriber of a node
                on a topic decides.
            buff_size: checked, and without effect.
            tcp_nodelay: accepted.

        Raises:
            ValueError: see `TopicHandle`.
            ROSException: a queue or buffer size that is no positive integer.
            UsageError: the topic's MsgId belongs to another topic.
        """
        super().__init__(name, data_class, "sub")
        if queue_size is not None:
            if not isinstance(queue_size, int):
                raise ROSException("queue size must be an integer")
            if queue_size <= 0:
                raise ROSException("queue size may not be set to zero")
        if not isinstance(buff_size, int) or buff_size <= 0:
            raise ROSException("buffer size must be a positive integer")
        self.callback = callback
        self.callback_args = callback_args
        self.impl = subscription = self._node.subscription(self.resolved_name, data_class, queue_size)
        subscription.handles += 1
        if callback is not None:
            subscription.add_callback(callback, callback_args)

    def unregister(self) -> None:
        """Stop subscribing with this handle."""
        subscription = self.impl
        if subscription is None:
            return
        self.impl = None
        if self.callback is not None:
            subscription.remove_callback(self.callback, self.callback_args)
        subscription.handles -= 1
        if subscription.handles == 0:
            subscription.close()


def make_subscriber(node: Node) -> type[Subscriber]:
    """The class `rospy.Subscriber` of a node."""
    return type("Subscriber", (Subscriber,), {"__module__": Subscriber.__module__, "_node": node})
