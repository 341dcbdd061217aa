"""Starts the expiry time of a goal whose handles are gone."""

from __future__ import annotations

from typing import TYPE_CHECKING

import rospy

if TYPE_CHECKING:
    from .action_server import ActionServer
    from .status_tracker import StatusTracker


class HandleTrackerDeleter:
    """Records when the last handle of a goal was deleted. The server forgets the goal some time after."""

    def __init__(self, action_server: ActionServer, status_tracker: StatusTracker) -> None:
        self.action_server = action_server
        self.status_tracker = status_tracker

    def __call__(self, ptr: object) -> None:
        """The handle `ptr` is gone."""
        with self.action_server.lock:
            self.status_tracker.handle_destruction_time = rospy.Time.now()
