"""A goal at its client: the state machine that follows it, and the handle that user code holds."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import rospy
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray

from ._states import TERMINAL_STATES, TRANSITIONS, CommState

_SILENCE_IS_FINE = (CommState.WAITING_FOR_GOAL_ACK, CommState.WAITING_FOR_RESULT, CommState.DONE)


class CommStateMachine:
    """Follows one goal through the server's messages.

    Args:
        action_goal: the *ActionGoal message that was sent.
        transition_cb: called with a handle at each change of state; or None.
        feedback_cb: called with a handle and the *Feedback; or None.
        send_goal_fn: publishes goals.
        send_cancel_fn: publishes cancel requests.
    """

    def __init__(
        self,
        action_goal: Any,
        transition_cb: Callable[[ClientGoalHandle], object] | None,
        feedback_cb: Callable[[ClientGoalHandle, Any], object] | None,
        send_goal_fn: Callable[[Any], object],
        send_cancel_fn: Callable[[Any], object],
    ) -> None:
        self.action_goal = action_goal
        self.transition_cb = transition_cb
        self.feedback_cb = feedback_cb
        self.send_goal_fn = send_goal_fn
        self.send_cancel_fn = send_cancel_fn
        self.state = CommState.WAITING_FOR_GOAL_ACK
        self.mutex = threading.RLock()
        self.latest_goal_status = GoalStatus(status=GoalStatus.PENDING)
        self.latest_result: Any = None

    @property
    def _id(self) -> str:
        return str(self.action_goal.goal_id.id)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, CommStateMachine) and self._id == other._id

    def __hash__(self) -> int:
        return hash(self._id)

    def set_state(self, state: int) -> None:
        """Set the state, without a call of the user's function."""
        self.state = state

    def transition_to(self, state: int) -> None:
        """Change the state and call the user."""
        texts = CommState.to_string(state), CommState.to_string(self.state), self._id
        rospy.logdebug("Transitioning to %s (from %s, goal: %s)", *texts)
        self.state = state
        if self.transition_cb:
            self.transition_cb(ClientGoalHandle(self))

    def update_status(self, status_array: Any) -> None:
        """Process the server's list of goals. A goal that is missing there is lost, or not known yet."""
        with self.mutex:
            if self.state == CommState.DONE:
                return
            status = next((each for each in status_array.status_list if each.goal_id.id == self._id), None)
            if status is not None:
                self.latest_goal_status = status
                self._follow(status.status)
            elif self.state not in _SILENCE_IS_FINE:
                self.latest_goal_status.status = GoalStatus.LOST
                self.transition_to(CommState.DONE)

    def _follow(self, status: int) -> None:
        row = TRANSITIONS.get(self.state)
        if row is None:
            rospy.logerr(f"CommStateMachine is in a funny state: {self.state}")
        elif status >= len(row):
            rospy.logerr(f"Got an unknown status from the ActionServer: {status}")
        elif (path := row[status]) is None:
            texts = CommState.to_string(self.state), GoalStatus.to_string(status)
            rospy.logerr("Invalid goal status transition from {} to {}".format(*texts))
        else:
            for state in path:
                self.transition_to(state)

    def update_result(self, action_result: Any) -> None:
        """Process a result, which may be another goal's."""
        if action_result.status.goal_id.id != self._id:
            return
        with self.mutex:
            self.latest_goal_status = action_result.status
            self.latest_result = action_result
            if self.state == CommState.DONE:
                rospy.logerr("Got a result when we were already in the DONE state")
            elif self.state not in TRANSITIONS:
                rospy.logerr(f"In a funny state: {self.state}")
            else:
                self.update_status(GoalStatusArray(status_list=[action_result.status]))
                self.transition_to(CommState.DONE)

    def update_feedback(self, action_feedback: Any) -> None:
        """Process feedback, which may be another goal's."""
        if action_feedback.status.goal_id.id == self._id and self.feedback_cb and self.state != CommState.DONE:
            self.feedback_cb(ClientGoalHandle(self), action_feedback.feedback)


class ClientGoalHandle:
    """A goal that was sent, as `ActionClient.send_goal` returns it; the goal is followed as long as one exists."""

    def __init__(self, comm_state_machine: CommStateMachine | None) -> None:
        self.comm_state_machine = comm_state_machine

    def __eq__(self, other: object) -> bool:
        return isinstance(other, ClientGoalHandle) and self.comm_state_machine == other.comm_state_machine

    def __hash__(self) -> int:
        return hash(self.comm_state_machine)

    def _machine(self, caller: str) -> CommStateMachine | None:
        if not self.comm_state_machine:
            rospy.logerr(f"Trying to {caller} on an inactive ClientGoalHandle.")
        return self.comm_state_machine

    def cancel(self) -> None:
        """Ask the server to cancel this goal."""
        machine: Any = self.comm_state_machine  # without one, AttributeError as in ROS
        with machine.mutex:
            machine.send_cancel_fn(GoalID(stamp=rospy.Time(0), id=machine.action_goal.goal_id.id))
            machine.transition_to(CommState.WAITING_FOR_CANCEL_ACK)

    def get_comm_state(self) -> int:
        """Return the goal's `CommState`."""
        machine = self._machine("get_comm_state")
        return machine.state if machine else CommState.LOST

    def get_goal_status(self) -> int:
        """Status number of actionlib_msgs/GoalStatus, as the server last said."""
        machine = self._machine("get_goal_status")
        return int(machine.latest_goal_status.status if machine else GoalStatus.PENDING)

    def get_goal_status_text(self) -> str:
        """Return the server's text for that status."""
        machine = self._machine("get_goal_status_text")
        if machine is None:
            return "ERROR: Trying to get_goal_status_text on an inactive ClientGoalHandle."
        return str(machine.latest_goal_status.text)

    def get_result(self) -> Any:
        """Return the *Result message, or None when none has come."""
        machine = self._machine("get_result")
        return machine.latest_result.result if machine and machine.latest_result else None

    def get_terminal_state(self) -> int:
        """Return the final state of the goal as a number of `TerminalState`, or LOST if it has not ended."""
        machine = self._machine("get_terminal_state")
        if machine is None:
            return int(GoalStatus.LOST)
        with machine.mutex:
            if machine.state != CommState.DONE:
                rospy.logwarn("Asking for the terminal state when we're in [%s]", CommState.to_string(machine.state))
            status = int(machine.latest_goal_status.status)
            if status in TERMINAL_STATES:
                return status
            rospy.logerr("Asking for a terminal state, but the goal status is %d", status)
            return int(GoalStatus.LOST)
