"""`LifecyclePublisher`: a publisher of a lifecycle node (rclpy.lifecycle.publisher)."""

from __future__ import annotations

from typing import Any

from rclpy.lifecycle.managed_entity import SimpleManagedEntity
from rclpy.publisher import Publisher


class LifecyclePublisher(SimpleManagedEntity, Publisher):
    """A publisher that publishes only while its node is active; it takes the arguments of `Publisher`."""

    def __init__(self, *args: Any, **kwargs: Any) -> None:
        SimpleManagedEntity.__init__(self)
        Publisher.__init__(self, *args, **kwargs)

    def publish(self, msg: Any) -> None:
        """Publish a message; without effect while the node is not active."""
        if self._enabled:
            Publisher.publish(self, msg)
