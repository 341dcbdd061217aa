"""`TransformListener`: fills a buffer from /tf and /tf_static (tf2_ros.transform_listener).

Imports rospy and tf2_msgs.
"""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import rospy
from tf2_msgs.msg import TFMessage


class TransformListener:
    """Listens to transforms.

    Args:
        buffer: has `set_transform`, `set_transform_static` and `clear`.
        queue_size: queue size of the subscribers; None for no limit.
        buff_size: buffer size of the subscribers, in bytes.
        tcp_nodelay: option of the subscribers.
    """

    def __init__(
        self, buffer: Any, queue_size: int | None = None, buff_size: int = 65536, tcp_nodelay: bool = False
    ) -> None:
        self.buffer = buffer
        self.last_update = rospy.Time.now()
        self.last_update_lock = threading.Lock()
        options = {"queue_size": queue_size, "buff_size": buff_size, "tcp_nodelay": tcp_nodelay}
        self.tf_sub = rospy.Subscriber("/tf", TFMessage, self.callback, **options)
        self.tf_static_sub = rospy.Subscriber("/tf_static", TFMessage, self.static_callback, **options)

    def __del__(self) -> None:
        self.unregister()

    def unregister(self) -> None:
        """Stop listening."""
        self.tf_sub.unregister()
        self.tf_static_sub.unregister()

    def check_for_reset(self) -> None:
        """Empty the buffer if the clock went back."""
        with self.last_update_lock:
            now = rospy.Time.now()
            if now < self.last_update:
                back = (self.last_update - now).to_sec()
                rospy.logwarn(f"Detected jump back in time of {back:f}s. Clearing TF buffer.")
                self.buffer.clear()
            self.last_update = now

    def callback(self, data: Any) -> None:
        """Take in transforms from /tf."""
        self.__take(data, self.buffer.set_transform)

    def static_callback(self, data: Any) -> None:
        """Take in transforms from /tf_static."""
        self.__take(data, self.buffer.set_transform_static)

    def __take(self, data: Any, put: Callable[[Any, str], None]) -> None:
        self.check_for_reset()
        who = data._connection_header.get("callerid", "default_authority")
        for transform in data.transforms:
            put(transform, who)
