"""`Timeout`: an action that runs unless it is postponed in time."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable
from typing import Any

import rospy


class Timeout:
    """A deadline.

    Args:
        duration: a rospy.Duration.
        on_timeout: called when it has passed since the last `reset`.
    """

    def __init__(self, duration: Any, on_timeout: Callable[[], object] | None = None) -> None:
        self.duration = duration
        self.on_timeout = on_timeout
        self.deadline = time.time()
        self.timer: threading.Timer | None = None

    def reset(self) -> Timeout:
        """Count from now."""
        self.cancel()
        self.timer = threading.Timer(self.duration.to_sec(), self._on_timer)
        self.timer.daemon = True
        self.timer.start()
        self.deadline = time.time() + self.duration.to_sec()
        return self

    def cancel(self) -> None:
        """It is not to happen."""
        if self.timer is not None:
            self.timer.cancel()

    def left(self) -> Any:
        """How long there is left, as a rospy.Duration."""
        return max(rospy.Duration(0), rospy.Duration(self.deadline - time.time()))

    def _on_timer(self) -> None:
        if self.on_timeout is not None:
            self.on_timeout()
