"""An action server's record of one goal."""

from __future__ import annotations

from typing import Any

import rospy
from actionlib_msgs.msg import GoalStatus

from .goal_id_generator import GoalIDGenerator


class StatusTracker:
    """A goal's status.

    Args:
        goal_id: id of a goal that has not arrived, but for which a cancel request has.
        status: status of that goal.
        goal: the *ActionGoal message of a goal that has arrived; it is pending, and gets an id and a stamp if it has
            none.
    """

    def __init__(self, goal_id: Any = None, status: int | None = None, goal: Any = None) -> None:
        self.goal = None if goal_id else goal
        self.handle_tracker: Any = None
        self.handle_destruction_time = rospy.Time()
        self.id_generator = GoalIDGenerator()
        if goal_id:
            self.status = GoalStatus(goal_id=goal_id, status=status, text="")
            return
        self.status = GoalStatus(goal_id=goal.goal_id, status=GoalStatus.PENDING, text="")
        if self.status.goal_id.id == "":
            self.status.goal_id = self.id_generator.generate_ID()
        if self.status.goal_id.stamp == rospy.Time():
            self.status.goal_id.stamp = rospy.Time.now()
