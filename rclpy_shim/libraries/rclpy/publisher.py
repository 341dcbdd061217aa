"""`Publisher` (rclpy.publisher)."""

from __future__ import annotations

from typing import Any

from rclpy import _seam
from rclpy.event_handler import PublisherEventCallbacks
from rclpy.qos import QoSProfile


class Publisher:
    """Publishes messages on a topic; `Node.create_publisher` makes one.

    Args:
        node: its node.
        msg_type: message class.
        topic: resolved name of the topic.
        qos_profile: its quality of service.
        event_callbacks: callbacks for its events; None for the usual ones.
        callback_group: their group.
        given_name: the topic as the program names it.
    """

    def __init__(
        self,
        node: Any,
        msg_type: Any,
        topic: str,
        qos_profile: QoSProfile,
        *,
        event_callbacks: PublisherEventCallbacks | None = None,
        callback_group: Any = None,
        given_name: str = "",
    ) -> None:
        self.msg_type = msg_type
        self.topic = topic
        self.qos_profile = qos_profile
        self._side = _seam.program.add_publisher(topic, msg_type, qos_profile.quality(), node.get_logger().warning)
        self._send = self._side.send
        callbacks = event_callbacks or PublisherEventCallbacks()
        group = node.default_callback_group if callback_group is None else callback_group
        warn = node.get_logger().warning
        self.event_handlers = callbacks.create_event_handlers(group, self._side, given_name or topic, warn)

    @property
    def topic_name(self) -> str:
        """The resolved name of the topic."""
        return self.topic

    def publish(self, msg: Any) -> None:
        """Publish a message.

        Raises:
            TypeError: it is not of the topic's type, or a field holds a value that its type cannot carry.
            NotImplementedError: it is a serialized message.
        """
        if not isinstance(msg, self.msg_type):
            if isinstance(msg, bytes):
                raise NotImplementedError("cfepy does not have serialized messages for nodes of ROS 2 yet")
            raise TypeError(f"Expected {self.msg_type}, got {type(msg)}")
        self._send(msg)

    def get_subscription_count(self) -> int:
        """Return the number of subscriptions that get the messages."""
        return int(self._side.count())

    def destroy(self) -> None:
        """Leave the topic."""
        _seam.program.close(self._side)

    def assert_liveliness(self) -> None:
        """Say that the publisher is alive, for MANUAL_BY_TOPIC."""
        self._side.assert_liveliness()

    def wait_for_all_acked(self, timeout: Any = None) -> bool:
        """Return True: the bus has handed each message over when `publish` returns."""
        return True

    def __enter__(self) -> Publisher:
        return self

    def __exit__(self, *error: object) -> None:
        self.destroy()
