"""`rospy.Publisher`: a node's handle on a topic that it publishes. Imports nothing of cfepy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rospy_shim.exceptions import ROSException
from rospy_shim.message import args_kwds_to_message
from rospy_shim.topic_handle import TopicHandle

if TYPE_CHECKING:
    from rospy_shim.link import Link, SubscribeListener
    from rospy_shim.node import Node

NO_QUEUE_SIZE = (
    "The publisher should be created with an explicit keyword argument 'queue_size'. It has no effect here, but on"
    " ROS a publisher without it waits for its slowest subscriber."
)


class Publisher(TopicHandle):
    """A node's handle on a topic that it publishes; each node has a subclass that knows the node."""

    __module__ = "rospy.topics"
    impl: Link | None

    def __init__(
        self,
        name: str,
        data_class: Any,
        subscriber_listener: SubscribeListener | None = None,
        tcp_nodelay: bool = False,
        latch: bool = False,
        headers: dict[str, str] | None = None,
        queue_size: int | None = None,
    ) -> None:
        """Publish on a topic.

        Args:
            name: of the topic.
            data_class: message class.
            subscriber_listener: is told of subscribers that come and go.
            tcp_nodelay: accepted.
            latch: subscribers that come later get the last message.
            headers: added to the connection header.
            queue_size: accepted; a warning reminds of it, as in rospy, when it is left out.

        Raises:
            ValueError: see `TopicHandle`.
            UsageError: the topic's MsgId belongs to another topic.
        """
        super().__init__(name, data_class, "pub")
        node = self._node
        if queue_size is None:
            node.warn(NO_QUEUE_SIZE, SyntaxWarning)
        self.impl = link = node.link(self.resolved_name, data_class)
        link.ref_count += 1
        if latch:
            link.enable_latch()
        if headers:
            link.header.update(headers)
        if subscriber_listener is not None:
            link.subscriber_listeners.append(subscriber_listener)
            if link.topic is not None:
                for subscription in link.topic.subscriptions:
                    link.peer_joined(subscription)

    def publish(self, *args: Any, **kwds: Any) -> None:
        """Send a message, given as such or by its fields.

        Raises:
            ROSException: before `init_node`, or after `unregister`.
            ROSSerializationException: a field holds what its type cannot carry.
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
        self.impl = None
        link.ref_count -= 1
        if link.ref_count == 0:
            link.close()


def make_publisher(node: Node) -> type[Publisher]:
    """The class `rospy.Publisher` of a node."""
    return type("Publisher", (Publisher,), {"__module__": Publisher.__module__, "_node": node})
