"""Ids for goals that have none."""

from __future__ import annotations

from itertools import count
from typing import Any

import rospy
from actionlib_msgs.msg import GoalID

_goal_numbers = count(1)


class GoalIDGenerator:
    """Makes goal ids, unique in the node.

    Args:
        name: prefix of the ids; None takes the node's name.
    """

    def __init__(self, name: str | None = None) -> None:
        self.set_name(rospy.get_name() if name is None else name)

    def set_name(self, name: str) -> None:
        """Set the prefix of the ids."""
        self.name = name

    def generate_ID(self) -> Any:  # actionlib's name
        """Return a new GoalID, stamped now."""
        now = rospy.Time.now()
        return GoalID(id=self.name + f"-{next(_goal_numbers)}-{now.secs}.{now.nsecs}", stamp=now)
