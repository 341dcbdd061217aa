"""`ActionClient`: sends goals to an action server and follows each of them."""

from __future__ import annotations

import time
import weakref
from collections.abc import Callable
from itertools import count
from threading import RLock
from typing import Any

import rospy
from actionlib_msgs.msg import GoalID, GoalStatusArray

from ._action_spec import ActionTypes
from ._client_goal_handle import ClientGoalHandle, CommStateMachine
from ._states import CommState, TerminalState, get_name_of_constant
from .exceptions import ActionException

__all__ = [
    "ActionClient",
    "ActionException",
    "ClientGoalHandle",
    "CommState",
    "CommStateMachine",
    "GoalManager",
    "TerminalState",
    "get_name_of_constant",
]

NO_TRANSITION, INVALID_TRANSITION = -1, -2
g_goal_id = 1

_goal_numbers = count(1)


class GoalManager:
    """Makes goals and passes the server's messages on to each. A goal whose handle is gone is forgotten.

    Args:
        ActionSpec: class of the *Action message.
    """

    def __init__(self, ActionSpec: Any) -> None:
        ActionTypes(ActionSpec).give_to(self)
        self.list_mutex = RLock()
        self.statuses: list[weakref.ref[CommStateMachine]] = []
        self.send_goal_fn: Callable[[Any], object] | None = None
        self.cancel_fn: Callable[[Any], object] | None = None

    ActionGoal: Any

    def register_send_goal_fn(self, fn: Callable[[Any], object]) -> None:
        """Set the function that publishes goals."""
        self.send_goal_fn = fn

    def register_cancel_fn(self, fn: Callable[[Any], object]) -> None:
        """Set the function that publishes cancel requests."""
        self.cancel_fn = fn

    def init_goal(self, goal: Any, transition_cb: Any = None, feedback_cb: Any = None) -> ClientGoalHandle:
        """Send a goal, and follow it from now on."""
        if self.send_goal_fn is None or self.cancel_fn is None:
            raise ActionException("register_send_goal_fn and register_cancel_fn come first")
        action_goal = self.ActionGoal(goal_id=self._generate_id(), goal=goal)
        action_goal.header.stamp = rospy.get_rostime()
        machine = CommStateMachine(action_goal, transition_cb, feedback_cb, self.send_goal_fn, self.cancel_fn)
        with self.list_mutex:
            self.statuses.append(weakref.ref(machine))
        self.send_goal_fn(action_goal)
        return ClientGoalHandle(machine)

    def _generate_id(self) -> Any:
        now = rospy.Time.now()
        return GoalID(id=f"{rospy.get_caller_id()}-{next(_goal_numbers)}-{now.to_sec():.3f}", stamp=now)

    def _living(self) -> list[CommStateMachine]:
        with self.list_mutex:
            living = [machine for machine in (ref() for ref in self.statuses) if machine is not None]
            self.statuses = [weakref.ref(machine) for machine in living]
        return living

    def update_statuses(self, status_array: Any) -> None:
        """Pass on the server's list of goals."""
        for machine in self._living():
            machine.update_status(status_array)

    def update_results(self, action_result: Any) -> None:
        """Pass on a result."""
        for machine in self._living():
            machine.update_result(action_result)

    def update_feedbacks(self, action_feedback: Any) -> None:
        """Pass on feedback."""
        for machine in self._living():
            machine.update_feedback(action_feedback)


class ActionClient:
    """Client of one action; any number of goals at a time.

    Args:
        ns: name of the action, the namespace of its topics.
        ActionSpec: class of the *Action message.

    Raises:
        ActionException: `ActionSpec` is not such a class.
    """

    ActionGoal: Any
    ActionResult: Any
    ActionFeedback: Any

    def __init__(self, ns: str, ActionSpec: Any) -> None:
        self.ns = ns
        self.last_status_msg: Any = None
        ActionTypes(ActionSpec).give_to(self)
        self.pub_queue_size = _at_least_zero(rospy.get_param("actionlib_client_pub_queue_size", 10), 10)
        self.pub_goal = self.__publisher("goal", self.ActionGoal)
        self.pub_cancel = self.__publisher("cancel", GoalID)
        self.manager = GoalManager(ActionSpec)
        self.manager.register_send_goal_fn(self.pub_goal.publish)
        self.manager.register_cancel_fn(self.pub_cancel.publish)
        self.sub_queue_size = _at_least_zero(rospy.get_param("actionlib_client_sub_queue_size", -1), None)
        self.status_sub = self.__subscriber("status", GoalStatusArray, self._status_cb)
        self.result_sub = self.__subscriber("result", self.ActionResult, self.manager.update_results)
        self.feedback_sub = self.__subscriber("feedback", self.ActionFeedback, self.manager.update_feedbacks)

    def __publisher(self, topic: str, kind: Any) -> Any:
        return rospy.Publisher(rospy.remap_name(self.ns) + f"/{topic}", kind, queue_size=self.pub_queue_size)

    def __subscriber(self, topic: str, kind: Any, callback: Callable[[Any], object]) -> Any:
        name = f"{rospy.remap_name(self.ns)}/{topic}"
        return rospy.Subscriber(name, kind, callback=callback, queue_size=self.sub_queue_size)

    def stop(self) -> None:
        """Leave the action's topics."""
        for each in (self.pub_goal, self.pub_cancel, self.status_sub, self.result_sub, self.feedback_sub):
            each.unregister()

    def send_goal(
        self,
        goal: Any,
        transition_cb: Callable[[ClientGoalHandle], object] | None = None,
        feedback_cb: Callable[[ClientGoalHandle, Any], object] | None = None,
    ) -> ClientGoalHandle:
        """Send a goal.

        Args:
            goal: the *Goal message.
            transition_cb: called with the handle at each change of `CommState`.
            feedback_cb: called with the handle and the *Feedback message.

        Returns:
            the goal's handle; the goal is followed as long as the handle lives.
        """
        return self.manager.init_goal(goal, transition_cb, feedback_cb)

    def cancel_all_goals(self) -> None:
        """Ask the server to cancel everything it does, for whomever."""
        self.pub_cancel.publish(GoalID(stamp=rospy.Time(0), id=""))

    def cancel_goals_at_and_before_time(self, time: Any) -> None:
        """Ask the server to cancel the goals with a stamp up to `time`, a rospy.Time."""
        self.pub_cancel.publish(GoalID(stamp=time, id=""))

    def wait_for_action_server_to_start(self, timeout: Any = rospy.Duration(0)) -> bool:  # noqa: B008
        """Old name of `wait_for_server`."""
        return self.wait_for_server(timeout)

    def wait_for_server(self, timeout: Any = rospy.Duration(0)) -> bool:  # noqa: B008
        """Wait until all five topics are connected to one server.

        Args:
            timeout: a rospy.Duration; zero waits forever.

        Returns:
            whether the server is available.
        """
        end = rospy.get_rostime() + timeout
        while not rospy.is_shutdown():
            if self.__is_connected():
                return True
            if timeout != rospy.Duration(0) and rospy.get_rostime() >= end:
                return False
            time.sleep(0.01)
        return False

    def __is_connected(self) -> bool:
        if self.last_status_msg is None:
            return False
        server = self.last_status_msg._connection_header["callerid"]
        takes = all(publisher.impl.has_connection(server) for publisher in (self.pub_goal, self.pub_cancel))
        return takes and all(
            any(connection.callerid_pub == server for connection in subscriber.impl.connections)
            for subscriber in (self.result_sub, self.feedback_sub)
        )

    def _status_cb(self, msg: Any) -> None:
        self.last_status_msg = msg
        self.manager.update_statuses(msg)


def _at_least_zero(value: int, otherwise: int | None) -> int | None:
    return otherwise if value < 0 else value
