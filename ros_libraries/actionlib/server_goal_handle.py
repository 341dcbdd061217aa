"""A goal at its server: the handle by which user code accepts, answers and ends it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import rospy
from actionlib_msgs.msg import GoalID, GoalStatus

if TYPE_CHECKING:
    from .action_server import ActionServer
    from .status_tracker import StatusTracker

_PENDING, _ACTIVE = GoalStatus.PENDING, GoalStatus.ACTIVE
_RECALLING, _PREEMPTING = GoalStatus.RECALLING, GoalStatus.PREEMPTING

# For each request: status before and after.
_ACCEPT = {_PENDING: _ACTIVE, _RECALLING: _PREEMPTING}
_REQUEST_CANCEL = {_PENDING: _RECALLING, _ACTIVE: _PREEMPTING}
_CANCEL = {
    _PENDING: GoalStatus.RECALLED,
    _RECALLING: GoalStatus.RECALLED,
    _ACTIVE: GoalStatus.PREEMPTED,
    _PREEMPTING: GoalStatus.PREEMPTED,
}
_REJECT = {_PENDING: GoalStatus.REJECTED, _RECALLING: GoalStatus.REJECTED}
_ABORT = {_PREEMPTING: GoalStatus.ABORTED, _ACTIVE: GoalStatus.ABORTED}
_SUCCEED = {_PREEMPTING: GoalStatus.SUCCEEDED, _ACTIVE: GoalStatus.SUCCEEDED}


class ServerGoalHandle:
    """A goal that an action server received. The server creates it; without arguments it is the handle of no goal."""

    def __init__(
        self,
        status_tracker: StatusTracker | None = None,
        action_server: ActionServer | None = None,
        handle_tracker: Any = None,
    ) -> None:
        self.status_tracker: Any = status_tracker
        self.action_server: Any = action_server
        self.handle_tracker = handle_tracker
        self.goal = status_tracker.goal if status_tracker else None

    # -- server actions ------------------------------------------------------------------------------------------

    def set_accepted(self, text: str = "") -> None:
        """Work on the goal begins: it is active, or preempting when it was asked to be cancelled before."""
        self._debug("Accepting goal, id: %s, stamp: %.2f")
        if not self._has_goal():
            return
        with self.action_server.lock:
            if self._enter(_ACCEPT, "an active state", "a pending or recalling", text):
                self.action_server.publish_status()

    def set_canceled(self, result: Any = None, text: str = "") -> None:
        """The goal is given up as asked: recalled when it was not accepted yet, else preempted."""
        self._debug("Setting status to canceled on goal, id: %s, stamp: %.2f")
        self._end(_CANCEL, "a cancelled state", "a pending, recalling, active, or preempting", result, text)

    def set_rejected(self, result: Any = None, text: str = "") -> None:
        """The server does not take the goal on."""
        self._debug("Setting status to rejected on goal, id: %s, stamp: %.2f")
        self._end(_REJECT, "a rejected state", "a pending or recalling", result, text)

    def set_aborted(self, result: Any = None, text: str = "") -> None:
        """The server failed."""
        self._debug("Setting status to aborted on goal, id: %s, stamp: %.2f")
        self._end(_ABORT, "an aborted state", "a preempting or active", result, text)

    def set_succeeded(self, result: Any = None, text: str = "") -> None:
        """The goal is reached."""
        self._debug("Setting status to succeeded on goal, id: %s, stamp: %.2f")
        self._end(_SUCCEED, "a succeeded state", "a preempting or active", result, text)

    def set_cancel_requested(self) -> bool:
        """Handle a client's cancel request.

        Returns whether the goal is in a state in which the user code is notified.
        """
        self._debug("Transisitoning to a cancel requested state on goal id: %s, stamp: %.2f")
        if self.goal is None:
            return False
        with self.action_server.lock:
            status = self.status_tracker.status
            if status.status not in _REQUEST_CANCEL:
                return False
            status.status = _REQUEST_CANCEL[status.status]
            self.action_server.publish_status()
            return True

    def publish_feedback(self, feedback: Any) -> None:
        """Send the progress to the clients; `feedback` is the *Feedback message."""
        self._debug("Publishing feedback for goal, id: %s, stamp: %.2f")
        if self.goal is None:
            rospy.logerr("Attempt to publish feedback on an uninitialized ServerGoalHandle")
            return
        with self.action_server.lock:
            self.action_server.publish_feedback(self.status_tracker.status, feedback)

    # -- properties ----------------------------------------------------------------------------------------------

    def get_default_result(self) -> Any:
        """Return an empty *Result message."""
        return self.action_server.ActionResultType()

    def get_goal(self) -> Any:
        """Return the *Goal message, or None."""
        return self.goal.goal if self.goal is not None else None

    def get_goal_id(self) -> Any:
        """Return the goal's GoalID."""
        if self.goal is None:
            rospy.logerr("Attempt to get a goal id on an uninitialized ServerGoalHandle")
            return GoalID()
        with self.action_server.lock:
            return self.status_tracker.status.goal_id

    def get_goal_status(self) -> Any:
        """Return the goal's GoalStatus, as it is published."""
        if self.goal is None:
            rospy.logerr("Attempt to get goal status on an uninitialized ServerGoalHandle")
            return GoalStatus()
        with self.action_server.lock:
            return self.status_tracker.status

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, ServerGoalHandle) or self.goal is None or other.goal is None:
            return False
        return bool(self.get_goal_id().id == other.get_goal_id().id)

    def __hash__(self) -> int:
        return hash(self.get_goal_id().id)

    # -- how -----------------------------------------------------------------------------------------------------

    def _debug(self, text: str) -> None:
        goal_id = self.get_goal_id()
        rospy.logdebug(text, goal_id.id, goal_id.stamp.to_sec())

    def _has_goal(self) -> bool:
        if self.goal is None:
            rospy.logerr("Attempt to set status on an uninitialized ServerGoalHandle")
        return self.goal is not None

    def _enter(self, ways: Mapping[int, int], target: str, sources: str, text: str) -> bool:
        status = self.status_tracker.status
        if status.status not in ways:
            problem = "To transition to %s, the goal must be in %s state, it is currently in state: %d"
            rospy.logerr(problem, target, sources, status.status)
            return False
        status.status = ways[status.status]
        status.text = text
        return True

    def _end(self, ways: Mapping[int, int], target: str, sources: str, result: Any, text: str) -> None:
        if not self._has_goal():
            return
        with self.action_server.lock:
            if self._enter(ways, target, sources, text):
                self.status_tracker.handle_destruction_time = rospy.Time.now()
                answer = self.get_default_result() if result is None else result
                self.action_server.publish_result(self.status_tracker.status, answer)
