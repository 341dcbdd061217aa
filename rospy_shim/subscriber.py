"""`rospy.Subscriber`: a node's handle on a topic that it subscribes to. Imports nothing of cfepy."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from rospy_shim.subscription import DEFAULT_BUFF_SIZE, Subscription
from rospy_shim.topic_handle import TopicHandle

if TYPE_CHECKING:
    from collections.abc import Callable

    from rospy_shim.node import Node


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
            queue_size: messages that may wait before the oldest ones are dropped; None is as many as the platform
                allows. The last subscriber of a node on a topic that says one decides.
            buff_size: checked, and without effect.
            tcp_nodelay: accepted.

        Raises:
            ValueError: see `TopicHandle`.
            ROSException: a queue or buffer size that is no positive integer.
            UsageError: the topic's MsgId belongs to another topic.
        """
        super().__init__(name, data_class, "sub")
        self.callback = callback
        self.callback_args = callback_args
        self.impl = subscription = self._node.subscription(self.resolved_name, data_class)
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
        self.impl = None
        if self.callback is not None:
            subscription.remove_callback(self.callback, self.callback_args)
        subscription.ref_count -= 1
        if subscription.ref_count == 0:
            subscription.close()


def make_subscriber(node: Node) -> type[Subscriber]:
    """The class `rospy.Subscriber` of a node."""
    return type("Subscriber", (Subscriber,), {"__module__": Subscriber.__module__, "_node": node})
