"""`SimpleActionClient`: one goal at a time, in three states."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import rospy
from actionlib_msgs.msg import GoalStatus

from ._client_goal_handle import ClientGoalHandle
from ._states import CommState, get_name_of_constant
from .action_client import ActionClient

_POLL = rospy.Duration(0.1)  # how long a wait takes to notice that the node shuts down

_SIMPLIFIED: dict[int, int] = {GoalStatus.RECALLING: GoalStatus.PENDING, GoalStatus.PREEMPTING: GoalStatus.ACTIVE}


class SimpleGoalState:
    """Where a goal has got to, for a client that does not care about details."""

    PENDING = 0
    ACTIVE = 1
    DONE = 2

    to_string: Any = classmethod(get_name_of_constant)


class SimpleActionClient:
    """Client of one action that follows the goal it sent last.

    Args:
        ns: name of the action, the namespace of its topics.
        ActionSpec: class of the *Action message.

    Raises:
        ActionException: `ActionSpec` is not such a class.
    """

    def __init__(self, ns: str, ActionSpec: Any) -> None:
        self.action_client = ActionClient(ns, ActionSpec)
        self.simple_state = SimpleGoalState.DONE
        self.gh: ClientGoalHandle | None = None
        self.done_condition = threading.Condition()

    def wait_for_server(self, timeout: Any = rospy.Duration()) -> bool:  # noqa: B008
        """Wait as `ActionClient.wait_for_server` does."""
        return self.action_client.wait_for_server(timeout)

    def send_goal(
        self,
        goal: Any,
        done_cb: Callable[[int, Any], object] | None = None,
        active_cb: Callable[[], object] | None = None,
        feedback_cb: Callable[[Any], object] | None = None,
    ) -> None:
        """Send a goal and follow it; the one before is forgotten, not cancelled.

        Args:
            goal: the *Goal message.
            done_cb: called at the end with the number of `TerminalState` and the *Result message or None.
            active_cb: called when the server begins to work on it.
            feedback_cb: called with the *Feedback message.
        """
        self.stop_tracking_goal()
        self.done_cb, self.active_cb, self.feedback_cb = done_cb, active_cb, feedback_cb
        self.simple_state = SimpleGoalState.PENDING
        self.gh = self.action_client.send_goal(goal, self._handle_transition, self._handle_feedback)

    def send_goal_and_wait(
        self,
        goal: Any,
        execute_timeout: Any = rospy.Duration(),  # noqa: B008
        preempt_timeout: Any = rospy.Duration(),  # noqa: B008
    ) -> int:
        """Send a goal and wait for its end; cancel it if that takes too long.

        Args:
            goal: the *Goal message.
            execute_timeout: a rospy.Duration before it is cancelled; zero waits forever.
            preempt_timeout: how long to wait after that.

        Returns:
            as `get_state`.
        """
        self.send_goal(goal)
        if not self.wait_for_result(execute_timeout):
            rospy.logdebug("Canceling goal")
            self.cancel_goal()
            in_time = self.wait_for_result(preempt_timeout)
            outcome = "Preempt finished within specified" if in_time else "Preempt didn't finish specified"
            rospy.logdebug(f"{outcome} preempt_timeout [{preempt_timeout.to_sec():.2f}]")
        return self.get_state()

    def wait_for_result(self, timeout: Any = rospy.Duration()) -> bool:  # noqa: B008
        """Wait until the goal is done.

        Args:
            timeout: a rospy.Duration; zero waits forever.

        Returns:
            whether it is done.
        """
        if not self.gh:
            rospy.logerr("Called wait_for_result when no goal exists")
            return False
        end = rospy.get_rostime() + timeout
        endless = timeout == rospy.Duration()
        with self.done_condition:
            while not rospy.is_shutdown() and self.simple_state != SimpleGoalState.DONE:
                left = _POLL if endless else min(end - rospy.get_rostime(), _POLL)
                if left <= rospy.Duration():
                    break
                self.done_condition.wait(left.to_sec())
        return self.simple_state == SimpleGoalState.DONE

    def get_result(self) -> Any:
        """Return the *Result message of the goal, or None."""
        if not self.gh:
            rospy.logerr("Called get_result when no goal is running")
            return None
        return self.gh.get_result()

    def get_state(self) -> int:
        """Return the number of actionlib_msgs/GoalStatus without the states in between, or LOST without a goal."""
        if not self.gh:
            return int(GoalStatus.LOST)
        status = self.gh.get_goal_status()
        return _SIMPLIFIED.get(status, status)

    def get_goal_status_text(self) -> str:
        """Return the server's text for the goal's status."""
        if not self.gh:
            rospy.logerr("Called get_goal_status_text when no goal is running")
            return "ERROR: Called get_goal_status_text when no goal is running"
        return self.gh.get_goal_status_text()

    def cancel_all_goals(self) -> None:
        """As `ActionClient.cancel_all_goals`."""
        self.action_client.cancel_all_goals()

    def cancel_goals_at_and_before_time(self, time: Any) -> None:
        """As `ActionClient.cancel_goals_at_and_before_time`."""
        self.action_client.cancel_goals_at_and_before_time(time)

    def cancel_goal(self) -> None:
        """Ask the server to cancel the goal."""
        if self.gh:
            self.gh.cancel()

    def stop_tracking_goal(self) -> None:
        """Forget the goal, which is not cancelled."""
        self.gh = None

    # -- events of the goal --------------------------------------------------------------------------------------

    def _handle_transition(self, gh: ClientGoalHandle) -> None:
        if gh != self.gh:
            rospy.logerr("Got a transition callback on a goal handle that we're not tracking")
            return
        state = gh.get_comm_state()
        if state in (CommState.ACTIVE, CommState.PREEMPTING):
            self.__on_active(state)
        elif state == CommState.RECALLING:
            if self.simple_state != SimpleGoalState.PENDING:
                self.__complain(state)
        elif state == CommState.DONE:
            self.__on_done(gh)

    def __on_active(self, state: int) -> None:
        if self.simple_state == SimpleGoalState.PENDING:
            self._set_simple_state(SimpleGoalState.ACTIVE)
            if self.active_cb:
                self.active_cb()
        elif self.simple_state == SimpleGoalState.DONE:
            self.__complain(state)

    def __on_done(self, gh: ClientGoalHandle) -> None:
        if self.simple_state == SimpleGoalState.DONE:
            rospy.logerr("SimpleActionClient received DONE twice")
            return
        if self.done_cb:
            self.done_cb(gh.get_goal_status(), gh.get_result())
        with self.done_condition:
            self._set_simple_state(SimpleGoalState.DONE)
            self.done_condition.notify_all()

    def __complain(self, state: int) -> None:
        texts = CommState.to_string(state), SimpleGoalState.to_string(self.simple_state)
        place = rospy.resolve_name(self.action_client.ns)
        rospy.logerr(
            "Received comm state {} when in simple state {} with SimpleActionClient in NS {}".format(*texts, place)
        )

    def _handle_feedback(self, gh: ClientGoalHandle, feedback: Any) -> None:
        if not self.gh:
            return  # of the goal before, while the next one is being sent
        if gh != self.gh:
            ids = (each.comm_state_machine.action_goal.goal_id.id for each in (self.gh, gh) if each.comm_state_machine)
            problem = "Got a feedback callback on a goal handle that we're not tracking. {} vs {}"
            rospy.logerr(problem.format(*ids))
        elif self.feedback_cb:
            self.feedback_cb(feedback)

    def _set_simple_state(self, state: int) -> None:
        self.simple_state = state
