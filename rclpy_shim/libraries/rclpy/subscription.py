"""`Subscription` (rclpy.subscription)."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from typing import Any

from rclpy import _seam
from rclpy._entity import Call, Entity
from rclpy.event_handler import SubscriptionEventCallbacks
from rclpy.qos import QoSProfile


class Subscription(Entity):
    """Takes messages of a topic; `Node.create_subscription` makes one.

    Args:
        node: its node.
        msg_type: message class.
        topic: resolved name of the topic.
        callback: called with a message, and with a dictionary about it if it takes two arguments.
        callback_group: its group.
        qos_profile: its quality of service.
        event_callbacks: callbacks for its events; None for the usual ones.
        given_name: the topic as the program names it.

    Raises:
        RuntimeError: the callback takes another number of arguments.
    """

    def __init__(
        self,
        node: Any,
        msg_type: Any,
        topic: str,
        callback: Callable[..., Any],
        callback_group: Any,
        qos_profile: QoSProfile,
        *,
        event_callbacks: SubscriptionEventCallbacks | None = None,
        given_name: str = "",
    ) -> None:
        self.msg_type = msg_type
        self.topic = topic
        self.callback = callback
        self.callback_group = callback_group
        self.qos_profile = qos_profile
        self._wants_info = _takes_two(callback)
        self._side = _seam.program.add_subscription(topic, msg_type, qos_profile.quality(), node.get_logger().warning)
        self.ready = self._side.ready  # type: ignore[method-assign]  # without another call

        callbacks = event_callbacks or SubscriptionEventCallbacks()
        warn = node.get_logger().warning
        self.event_handlers = callbacks.create_event_handlers(callback_group, self._side, given_name or topic, warn)

    @property
    def topic_name(self) -> str:
        """The resolved name of the topic."""
        return self.topic

    def take_work(self, executor: Any) -> Call | None:
        """Take the oldest message; see `Entity.take_work`."""
        taken = self._side.take()
        if taken is None:
            return None
        if not self._wants_info:
            return self.callback, (taken[0],)
        now = _seam.now_ns()
        return self.callback, (taken[0], {"source_timestamp": now, "received_timestamp": now})

    def get_publisher_count(self) -> int:
        """Return the number of publishers whose messages come here."""
        return int(self._side.count())

    def destroy(self) -> None:
        """Leave the topic."""
        _seam.program.close(self._side)

    def __enter__(self) -> Subscription:
        return self

    def __exit__(self, *error: object) -> None:
        self.destroy()


def _takes_two(callback: Callable[..., Any]) -> bool:
    try:
        signature = inspect.signature(callback)
    except (TypeError, ValueError):
        return False
    for count in (1, 2):
        try:
            signature.bind(*[object()] * count)
        except TypeError:
            continue
        return count == 2
    raise RuntimeError(
        "Subscription.__init__(): callback should be either be callable with one argument(to get only "
        "the message) or two (to get message and message info)"
    )
