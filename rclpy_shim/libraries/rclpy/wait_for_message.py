"""`wait_for_message` (rclpy.wait_for_message)."""

from __future__ import annotations

from typing import Any

from rclpy import _seam
from rclpy.utilities import timeout_sec_to_nsec


def wait_for_message(
    msg_type: Any, node: Any, topic: str, *, qos_profile: Any = 1, time_to_wait: float = -1
) -> tuple[bool, Any]:
    """Wait for a message. No executor is needed, and no callback runs meanwhile.

    Args:
        msg_type: message class.
        node: node that makes a subscription for this time.
        topic: name of the topic.
        qos_profile: quality of service, or depth.
        time_to_wait: longest time in s; a negative one waits without limit.

    Returns:
        True and the message; False and None if none came.
    """
    subscription = node.create_subscription(msg_type, topic, lambda message: None, qos_profile)
    limit = timeout_sec_to_nsec(time_to_wait)
    end = None if limit < 0 else _seam.steady_ns() + limit
    waiting = _seam.program.waiting
    bell = waiting.bell()
    try:
        while node.context.ok():
            ready, is_late = waiting.wait(bell, [subscription], end, waiting.version)
            taken = subscription._side.take() if ready else None
            if taken is not None:
                return True, taken[0]
            if is_late:
                break
    finally:
        node.destroy_subscription(subscription)
    return False, None
