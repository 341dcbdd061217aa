"""`TransformListener`: fills a buffer from /tf and /tf_static (tf2_ros.transform_listener)."""

from __future__ import annotations

import threading
from typing import Any

from rclpy.callback_groups import ReentrantCallbackGroup
from rclpy.executors import SingleThreadedExecutor
from rclpy.qos import DurabilityPolicy, QoSProfile
from tf2_msgs.msg import TFMessage

_AUTHORITY = "default_authority"


class TransformListener:
    """Fills a buffer.

    Args:
        buffer: the buffer.
        node: its node.
        spin_thread: run the callbacks of the node in a thread of the listener.
        qos: quality of service, or depth, of /tf; None for a depth of 100.
        static_qos: quality of service, or depth, of /tf_static; None for a depth of 100, transient local.
        tf_topic: name of the topic with transforms over time.
        tf_static_topic: name of the topic with static transforms.
    """

    def __init__(
        self,
        buffer: Any,
        node: Any,
        *,
        spin_thread: bool = False,
        qos: QoSProfile | int | None = None,
        static_qos: QoSProfile | int | None = None,
        tf_topic: str = "/tf",
        tf_static_topic: str = "/tf_static",
    ) -> None:
        self.buffer = buffer
        self.node = node
        self.group = ReentrantCallbackGroup()
        usual = QoSProfile(depth=100) if qos is None else qos
        kept = QoSProfile(depth=100, durability=DurabilityPolicy.TRANSIENT_LOCAL) if static_qos is None else static_qos
        subscribe = node.create_subscription
        self.tf_sub = subscribe(TFMessage, tf_topic, self.callback, usual, callback_group=self.group)
        self.tf_static_sub = subscribe(
            TFMessage, tf_static_topic, self.static_callback, kept, callback_group=self.group
        )
        if spin_thread:
            self.executor = SingleThreadedExecutor()
            self.dedicated_listener_thread = threading.Thread(target=self._spin)
            self.dedicated_listener_thread.start()

    def _spin(self) -> None:
        self.executor.add_node(self.node)
        self.executor.spin()
        self.executor.remove_node(self.node)

    def unregister(self) -> None:
        """End the subscriptions."""
        self.node.destroy_subscription(self.tf_sub)
        self.node.destroy_subscription(self.tf_static_sub)

    def callback(self, data: Any) -> None:
        """Take in transforms over time."""
        for transform in data.transforms:
            self.buffer.set_transform(transform, _AUTHORITY)

    def static_callback(self, data: Any) -> None:
        """Take in static transforms."""
        for transform in data.transforms:
            self.buffer.set_transform_static(transform, _AUTHORITY)
