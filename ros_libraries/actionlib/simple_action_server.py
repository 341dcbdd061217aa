"""`SimpleActionServer`: one goal at a time; a newer goal replaces the one before."""

from __future__ import annotations

import threading
import traceback
from collections.abc import Callable
from typing import Any

import rospy
from actionlib_msgs.msg import GoalStatus

from .action_server import ActionServer, nop_cb
from .server_goal_handle import ServerGoalHandle

__all__ = ["SimpleActionServer", "nop_cb"]

_REPLACED = "This goal was canceled because another goal was received by the simple action server"
_ACCEPTED = "This goal has been accepted by the simple action server"
_POLL_S = 0.1


class SimpleActionServer:
    """Server of one action.

    Args:
        name: name of the action, the namespace of its topics.
        ActionSpec: class of the *Action message.
        execute_cb: called with the *Goal message in a separate thread, which does the work; None for a server that
            polls, or that uses callbacks.
        auto_start: whether to `start` at once, which is not recommended.

    Raises:
        ActionException: `ActionSpec` is not such a class.
    """

    def __init__(
        self, name: str, ActionSpec: Any, execute_cb: Callable[[Any], object] | None = None, auto_start: bool = True
    ) -> None:
        self.new_goal = False
        self.preempt_request = False
        self.new_goal_preempt_request = False
        self.execute_callback = execute_cb
        self.goal_callback: Callable[[], object] | None = None
        self.preempt_callback: Callable[[], object] | None = None
        # The action server calls us with its own lock held, so ours is always the second to be taken.
        self.lock = threading.RLock()
        self.execute_condition = threading.Condition(self.lock)
        self.current_goal = ServerGoalHandle()
        self.next_goal = ServerGoalHandle()
        self.execute_thread: threading.Thread | None = None
        if execute_cb:
            self.execute_thread = threading.Thread(target=self.executeLoop)
            self.execute_thread.start()
        callbacks = self.internal_goal_callback, self.internal_preempt_callback
        self.action_server = ActionServer(name, ActionSpec, *callbacks, auto_start)

    def start(self) -> None:
        """Begin to take goals."""
        self.action_server.start()

    def register_goal_callback(self, cb: Callable[[], object]) -> None:
        """Have `cb` called when a new goal is there to be accepted."""
        if self.execute_callback:
            rospy.logwarn(
                "Cannot call SimpleActionServer.register_goal_callback() because an executeCallback exists. "
                "Not going to register it."
            )
        else:
            self.goal_callback = cb

    def register_preempt_callback(self, cb: Callable[[], object]) -> None:
        """Have `cb` called when the goal is to be given up."""
        self.preempt_callback = cb

    # -- the goal --------------------------------------------------------------------------------------------------

    def accept_new_goal(self) -> Any:
        """Accept the new goal. The one before, if it is active, is preempted.

        Returns:
            the *Goal message, or None if there is no new goal.
        """
        with self.action_server.lock, self.lock:
            if not self.new_goal or self.next_goal.get_goal() is None:
                rospy.logerr("Attempting to accept the next goal when a new goal is not available")
                return None
            if self.is_active() and self.current_goal != self.next_goal:
                self.current_goal.set_canceled(None, _REPLACED)
            rospy.logdebug("Accepting a new goal")
            self.current_goal = self.next_goal
            self.new_goal = False
            self.preempt_request = self.new_goal_preempt_request
            self.new_goal_preempt_request = False
            self.current_goal.set_accepted(_ACCEPTED)
            return self.current_goal.get_goal()

    def is_new_goal_available(self) -> bool:
        """Return whether a goal waits to be accepted."""
        return self.new_goal

    def is_preempt_requested(self) -> bool:
        """Return whether the goal is to be given up, for a newer one or because a client wants it."""
        return self.preempt_request

    def is_active(self) -> bool:
        """Return whether there is a goal under way."""
        if self.current_goal.get_goal() is None:
            return False
        return self.current_goal.get_goal_status().status in (GoalStatus.ACTIVE, GoalStatus.PREEMPTING)

    def publish_feedback(self, feedback: Any) -> None:
        """Send the progress to the clients; `feedback` is the *Feedback message."""
        self.current_goal.publish_feedback(feedback)

    def get_default_result(self) -> Any:
        """Return an empty *Result message."""
        return self.action_server.ActionResultType()

    def set_succeeded(self, result: Any = None, text: str = "") -> None:
        """The goal is reached."""
        with self.action_server.lock, self.lock:
            self.current_goal.set_succeeded(self.__or_empty(result), text)

    def set_aborted(self, result: Any = None, text: str = "") -> None:
        """The server failed."""
        with self.action_server.lock, self.lock:
            self.current_goal.set_aborted(self.__or_empty(result), text)

    def set_preempted(self, result: Any = None, text: str = "") -> None:
        """The goal is given up as asked."""
        with self.action_server.lock, self.lock:
            rospy.logdebug("Setting the current goal as canceled")
            self.current_goal.set_canceled(self.__or_empty(result), text)

    def __or_empty(self, result: Any) -> Any:
        return self.get_default_result() if result is None else result

    # -- receiving ---------------------------------------------------------------------------------------------------

    def internal_goal_callback(self, goal: ServerGoalHandle) -> None:
        """A goal came: it is the next one, unless it is older than the one there is."""
        with self.execute_condition:
            try:
                rospy.logdebug(
                    "A new goal %s has been received by the single goal action server", goal.get_goal_id().id
                )
                if not (_is_newer(goal, self.current_goal) and _is_newer(goal, self.next_goal)):
                    goal.set_canceled(None, _REPLACED)
                    return
                self.__line_up(goal)
                self.execute_condition.notify()
            except Exception as error:  # whatever a callback of the user raises
                rospy.logerr("SimpleActionServer.internal_goal_callback - exception %s", str(error))

    def __line_up(self, goal: ServerGoalHandle) -> None:
        waits = self.next_goal.get_goal() is not None
        if waits and (self.current_goal.get_goal() is None or self.next_goal != self.current_goal):
            self.next_goal.set_canceled(None, _REPLACED)
        self.next_goal = goal
        self.new_goal = True
        self.new_goal_preempt_request = False
        if self.is_active():
            self.preempt_request = True
            if self.preempt_callback:
                self.preempt_callback()
        if self.goal_callback:
            self.goal_callback()

    def internal_preempt_callback(self, preempt: ServerGoalHandle) -> None:
        """A client wants the goal under way, or the one that waits, to be given up."""
        with self.lock:
            rospy.logdebug("A preempt has been received by the SimpleActionServer")
            if preempt == self.current_goal:
                rospy.logdebug("Setting preempt_request bit for the current goal to TRUE and invoking callback")
                self.preempt_request = True
                if self.preempt_callback:
                    self.preempt_callback()
            elif preempt == self.next_goal:
                rospy.logdebug("Setting preempt request bit for the next goal to TRUE")
                self.new_goal_preempt_request = True

    # -- the thread that works -----------------------------------------------------------------------------------------

    def executeLoop(self) -> None:  # actionlib's name
        """Accept goals and run `execute_cb` for each, until the node shuts down."""
        while not rospy.is_shutdown():
            if self.is_active():
                rospy.logerr("Should never reach this code with an active goal")
                return
            if self.is_new_goal_available():
                self.__execute(self.accept_new_goal())
            with self.execute_condition:
                self.execute_condition.wait(_POLL_S)

    def __execute(self, goal: Any) -> None:
        if not self.execute_callback:
            rospy.logerr("execute_callback_ must exist. This is a bug in SimpleActionServer")
            return
        try:
            self.execute_callback(goal)
            if self.is_active():
                rospy.logwarn(
                    "Your executeCallback did not set the goal to a terminal status.  "
                    "This is a bug in your ActionServer implementation. Fix your code!  "
                    "For now, the ActionServer will set this goal to aborted"
                )
                self.set_aborted(None, "No terminal state was set.")
        except Exception as error:  # whatever user code raises
            rospy.logerr("Exception in your execute callback: %s\n%s", str(error), traceback.format_exc())
            self.set_aborted(None, f"Exception in execute callback: {error}")


def _is_newer(goal: ServerGoalHandle, other: ServerGoalHandle) -> bool:
    return other.get_goal() is None or bool(goal.get_goal_id().stamp >= other.get_goal_id().stamp)
