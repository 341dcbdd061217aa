"""actionlib for nodes: long-running jobs that a client can follow and cancel, over five topics.

Names, states, texts and timing match ROS's actionlib 1.14. The code is cfepy's own, and uses the node's `rospy`.
It is executed anew in each node that imports it, so nodes share none of its state. As with ROS's, a star import also
provides the modules that it uses.
"""

from __future__ import annotations

import threading
import time
import traceback
import weakref

import rospy
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray
from std_msgs.msg import Header

from ._client_goal_handle import ClientGoalHandle, CommStateMachine
from ._states import CommState, TerminalState, get_name_of_constant
from .action_client import INVALID_TRANSITION, NO_TRANSITION, ActionClient, GoalManager, g_goal_id
from .action_server import ActionServer, nop_cb
from .exceptions import ActionException
from .goal_id_generator import GoalIDGenerator
from .handle_tracker_deleter import HandleTrackerDeleter
from .server_goal_handle import ServerGoalHandle
from .simple_action_client import SimpleActionClient, SimpleGoalState
from .simple_action_server import SimpleActionServer
from .status_tracker import StatusTracker

__all__ = [
    "INVALID_TRANSITION",
    "NO_TRANSITION",
    "ActionClient",
    "ActionException",
    "ActionServer",
    "ClientGoalHandle",
    "CommState",
    "CommStateMachine",
    "GoalID",
    "GoalIDGenerator",
    "GoalManager",
    "GoalStatus",
    "GoalStatusArray",
    "HandleTrackerDeleter",
    "Header",
    "ServerGoalHandle",
    "SimpleActionClient",
    "SimpleActionServer",
    "SimpleGoalState",
    "StatusTracker",
    "TerminalState",
    "g_goal_id",
    "get_name_of_constant",
    "nop_cb",
    "rospy",
    "threading",
    "time",
    "traceback",
    "weakref",
]
