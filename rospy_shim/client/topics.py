"""`rospy.topics` of a node: its handles for publishing and subscribing, and the lists of its topics.

Handles of one node on one topic share a side of it, a `Link` or a `Subscription`. Tools and bridges such as rosapi read
the manager's lists (rospy.impl.registration).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, cast

from rospy_shim.client.message import args_kwds_to_message
from rospy_shim.client.subscription import DEFAULT_BUFF_SIZE, Subscription
from rospy_shim.types.exceptions import ROSException
from rospy_shim.types.genpy import Message
from rospy_shim.types.names import is_legal_name

if TYPE_CHECKING:
    from collections.abc import Callable

    from rospy_shim.client.link import Link, SubscribeListener
    from rospy_shim.client.node import Node
    from rospy_shim.client.service import Service
    from rospy_shim.types.msgs import MessageClass

NO_QUEUE_SIZE = (
    "The publisher should be created with an explicit keyword argument 'queue_size'. Please see"
    " http://wiki.ros.org/rospy/Overview/Publishers%20and%20Subscribers for more information."
)
PUB, SUB = "pub", "sub"


class TopicHandle:
    """A topic as one side of a node sees it; `impl` is shared by all handles of the side, None once unregistered."""

    __module__ = "rospy.topics"
    __node__: ClassVar[Node]
    impl: Any = None

    def __init__(self, name: str, data_class: MessageClass, reg_type: str) -> None:
        """Check the arguments and resolve the name.

        Raises:
            ValueError: an empty name, a class that is not a message class, or a private name before `init_node`.
        """
        if not name or not isinstance(name, str):
            raise ValueError("topic name is not a non-empty string")
        if data_class is None:
            raise ValueError("topic parameter 'data_class' is not initialized")
        if not isinstance(data_class, type):
            raise ValueError(f"data_class [{data_class}] is not a class")
        if not issubclass(data_class, Message):
            raise ValueError(f"data_class [{type(data_class).__name__}] is not a message data class")
        node = self.__node__
        if not is_legal_name(name):
            node.warn_of_illegal(name)
        names = node.names
        if node.initialized:
            self.resolved_name = names.resolve_name(name)
        else:
            self.resolved_name = names.resolve_name_without_node_name(name)
        self.name = self.resolved_name
        self.data_class = message = cast(Any, data_class)
        self.type: str = message._type
        self.md5sum: str = message._md5sum
        self.reg_type = reg_type
        node.wait_for_registration()

    def get_num_connections(self) -> int:
        """Return the number of connections.

        Raises:
            AttributeError: after `unregister`.
        """
        self.__node__.universe.charge()
        return int(self.impl.get_num_connections())

    def __forget__(self) -> None:
        """Lose the topic after `unregister`, as on ROS."""
        self.impl = self.resolved_name = self.data_class = self.type = self.md5sum = cast(Any, None)


class Publisher(TopicHandle):
    """A node's handle on a topic that it publishes; each node has a subclass that knows the node."""

    __module__ = "rospy.topics"
    impl: Link | None

    def __init__(
        self,
        name: str,
        data_class: MessageClass,
        subscriber_listener: SubscribeListener | None = None,
        tcp_nodelay: bool = False,
        latch: bool = False,
        headers: dict[str, str] | None = None,
        queue_size: int | None = None,
    ) -> None:
        """Publish on a topic.

        Args:
            name: name of the topic.
            data_class: message class.
            subscriber_listener: notified of new and lost subscribers.
            tcp_nodelay: accepted.
            latch: later subscribers get the last message.
            headers: added to the connection header.
            queue_size: messages that wait while the sockets of a slow subscriber are full
                (`rospy_shim.client.socket_buffers`); 0 for no limit. If it is missing, `publish` waits then, and a
                warning is printed, as in rospy. The last publisher of a node on a topic that sets it decides.

        Raises:
            ValueError: see `TopicHandle`.
            UsageError: the topic's MsgId belongs to another topic.
        """
        super().__init__(name, data_class, "pub")
        node = self.__node__
        if queue_size is None:
            node.warn(NO_QUEUE_SIZE, SyntaxWarning)
        self.impl = link = node.link(self.resolved_name, data_class)
        if queue_size is not None:
            link.queue_size = queue_size
        link.ref_count += 1
        if latch:
            link.enable_latch()
        if headers:
            link.header.update(headers)
        if subscriber_listener is not None:
            link.subscriber_listeners.append(subscriber_listener)
            if link.ref_count == 1:
                for subscription in link.peers:
                    link.peer_joined(subscription)

    def publish(self, *args: Any, **kwds: Any) -> None:
        """Send a message, given directly or by its fields.

        Raises:
            ROSException: before `init_node`, or after `unregister`.
            ROSSerializationException: a field holds a value that its type cannot carry.
            TypeError: the arguments do not make a message of the topic's type.
        """
        link = self.impl
        if link is None:
            raise ROSException("publish() to an unregistered() handle")
        if not link.connected:
            raise ROSException("ROS node has not been initialized yet. Please call init_node() first")
        if len(args) == 1 and not kwds and type(args[0]) is self.data_class:
            link.send(args[0])
        else:
            link.send(args_kwds_to_message(self.data_class, args, kwds))

    def unregister(self) -> None:
        """Stop publishing with this handle."""
        link = self.impl
        if link is None:
            return
        self.__forget__()
        link.ref_count -= 1
        if link.ref_count == 0:
            link.close()


def make_publisher(node: Node) -> type[Publisher]:
    """Make the class `rospy.Publisher` of a node."""
    return type("Publisher", (Publisher,), {"__module__": Publisher.__module__, "__node__": node})


class Subscriber(TopicHandle):
    """A node's handle on a topic that it subscribes to; each node has a subclass that knows the node."""

    __module__ = "rospy.topics"
    impl: Subscription | None

    def __init__(
        self,
        name: str,
        data_class: MessageClass,
        callback: Callable[..., Any] | None = None,
        callback_args: Any = None,
        queue_size: int | None = None,
        buff_size: int = DEFAULT_BUFF_SIZE,
        tcp_nodelay: bool = False,
    ) -> None:
        """Subscribe to a topic.

        Args:
            name: name of the topic.
            data_class: message class, or AnyMsg.
            callback: takes the message, and `callback_args` unless that is None.
            callback_args: second argument of the callback.
            queue_size: messages that may wait before the oldest ones are dropped; None is as many as the platform
                allows. The last subscriber of a node on a topic that sets it decides.
            buff_size: bytes of one read, among which a queue size drops messages (`rospy_shim.client.socket_buffers`).
            tcp_nodelay: accepted.

        Raises:
            ValueError: see `TopicHandle`.
            ROSException: a queue or buffer size that is not a positive integer.
            UsageError: the topic's MsgId belongs to another topic.
        """
        super().__init__(name, data_class, "sub")
        self.callback = callback
        self.callback_args = callback_args
        self.impl = subscription = self.__node__.subscription(self.resolved_name, data_class)
        if queue_size is not None:
            subscription.set_queue_size(queue_size)
        if buff_size != DEFAULT_BUFF_SIZE:
            subscription.set_buff_size(buff_size)
        if tcp_nodelay:
            subscription.set_tcp_nodelay(tcp_nodelay)
        subscription.ref_count += 1
        if callback is not None:
            subscription.add_callback(callback, callback_args)

    def unregister(self) -> None:
        """Stop subscribing with this handle."""
        subscription = self.impl
        if subscription is None:
            return
        self.__forget__()
        if self.callback is not None:
            subscription.remove_callback(self.callback, self.callback_args)
        subscription.ref_count -= 1
        if subscription.ref_count == 0:
            subscription.close()


def make_subscriber(node: Node) -> type[Subscriber]:
    """Make the class `rospy.Subscriber` of a node."""
    return type("Subscriber", (Subscriber,), {"__module__": Subscriber.__module__, "__node__": node})


class TopicManager:
    """The topics of one node (rospy.topics._TopicManager).

    Args:
        node: the node.
    """

    __module__ = "rospy.topics"

    def __init__(self, node: Node) -> None:
        self._node = node
        self.closed = False

    @property
    def pubs(self) -> dict[str, Link]:
        """The publishing sides by topic."""
        return self._node.links

    @property
    def subs(self) -> dict[str, Subscription]:
        """The subscribing sides by topic."""
        return self._node.subscriptions

    @property
    def topics(self) -> set[str]:
        """Names of all topics of the node."""
        return {*self.pubs, *self.subs}

    def get_topics(self) -> set[str]:
        """Return the names of all topics of the node."""
        return self.topics

    def get_publications(self) -> list[list[str]]:
        """Return [topic, type] of the published topics."""
        return [[name, side.type] for name, side in self.pubs.items()]

    def get_subscriptions(self) -> list[list[str]]:
        """Return [topic, type] of the subscribed topics."""
        return [[name, side.type] for name, side in self.subs.items()]

    def has_publication(self, resolved_name: str) -> bool:
        """Return True if the node publishes a topic."""
        return resolved_name in self.pubs

    def has_subscription(self, resolved_name: str) -> bool:
        """Return True if the node subscribes to a topic."""
        return resolved_name in self.subs

    def get_publisher_impl(self, resolved_name: str) -> Link | None:
        """Return the publishing side of a topic, or None."""
        return self.pubs.get(resolved_name)

    def get_subscriber_impl(self, resolved_name: str) -> Subscription | None:
        """Return the subscribing side of a topic, or None."""
        return self.subs.get(resolved_name)

    def get_impl(self, reg_type: str, resolved_name: str) -> Link | Subscription | None:
        """Return a side of a topic, or None.

        Args:
            reg_type: "pub" or "sub".
            resolved_name: name of the topic.

        Raises:
            TypeError: another `reg_type`.
        """
        return self.pubs.get(resolved_name) if _is_pub(reg_type) else self.subs.get(resolved_name)

    def acquire_impl(self, reg_type: str, resolved_name: str, data_class: MessageClass) -> Link | Subscription:
        """Return a side of a topic for one more handle; make it if there is none.

        Raises:
            TypeError: another `reg_type`.
        """
        node, pub = self._node, _is_pub(reg_type)
        side = node.link(resolved_name, data_class) if pub else node.subscription(resolved_name, data_class)
        side.ref_count += 1
        return side

    def release_impl(self, reg_type: str, resolved_name: str) -> None:
        """Release a handle's side of a topic; it is closed if the handle was the last one.

        Raises:
            TypeError: another `reg_type`.
        """
        side = self.get_impl(reg_type, resolved_name)
        if side is not None:
            side.ref_count -= 1
            if side.ref_count <= 0:
                side.close()

    def get_pub_sub_info(self) -> list[Any]:
        """Return all connections, in the form of getBusInfo of the slave API."""
        return [row for side in (*self.pubs.values(), *self.subs.values()) for row in side.get_stats_info()]

    def get_pub_sub_stats(self) -> tuple[list[Any], list[Any]]:
        """Return the numbers of the publishing and the subscribing sides, in the form of getBusStats."""
        return [side.get_stats() for side in self.pubs.values()], [side.get_stats() for side in self.subs.values()]

    def check_all(self) -> None:
        """Do nothing: a node that has left the bus is gone from the connections."""

    def close_all(self) -> None:
        """Close all sides."""
        self.closed = True
        for link in list(self.pubs.values()):
            link.close()
        for subscription in list(self.subs.values()):
            subscription.close()


def _is_pub(reg_type: str) -> bool:
    if reg_type not in (PUB, SUB):
        raise TypeError(f"invalid reg_type: {reg_type}")
    return reg_type == PUB


def offered(node: Node) -> dict[str, Service]:
    """Return the services that a node offers, by name."""
    return {service.resolved_name: service for service in node.services}
