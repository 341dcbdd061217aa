"""`ActionServer`: accepts goals and cancel requests, keeps their statuses, and publishes these five times a second."""

from __future__ import annotations

import threading
from collections.abc import Callable
from typing import Any

import rospy
from actionlib_msgs.msg import GoalID, GoalStatus, GoalStatusArray

from ._action_spec import ActionTypes
from .exceptions import ActionException
from .goal_id_generator import GoalIDGenerator
from .handle_tracker_deleter import HandleTrackerDeleter
from .server_goal_handle import ServerGoalHandle
from .status_tracker import StatusTracker

__all__ = [
    "ActionException",
    "ActionServer",
    "GoalIDGenerator",
    "HandleTrackerDeleter",
    "ServerGoalHandle",
    "StatusTracker",
    "nop_cb",
]

_TOO_LATE = (
    "This goal handle was canceled by the action server because its timestamp is before the timestamp of the "
    "last cancel request"
)


def nop_cb(goal_handle: ServerGoalHandle) -> None:
    """Cancel callback of a server that has none."""


def _is_over(tracker: StatusTracker, now: Any, oldest_ns: int) -> bool:
    """Return whether a goal ended before `oldest_ns`.

    It compares integers, because a server may check a thousand goals.
    """
    ended = tracker.handle_destruction_time
    ended_ns = ended.to_nsec()
    if ended_ns == 0 or ended_ns >= oldest_ns:
        return False
    texts = tracker.status.goal_id, ended.to_sec(), now.to_sec()
    rospy.logdebug("Item %s with destruction time of %.3f being removed from list.  Now = %.3f", *texts)
    return True


class ActionServer:
    """Server of one action, for any number of goals at a time.

    Args:
        ns: name of the action, the namespace of its topics.
        ActionSpec: class of the *Action message.
        goal_cb: called with a `ServerGoalHandle` for each new goal.
        cancel_cb: called with the handle of each goal to cancel.
        auto_start: whether to `start` at once, which is not recommended.

    Raises:
        ActionException: `ActionSpec` is not such a class.
    """

    ActionGoal: Any
    ActionResult: Any
    ActionResultType: Any
    ActionFeedback: Any

    def __init__(
        self,
        ns: str,
        ActionSpec: Any,
        goal_cb: Callable[[ServerGoalHandle], object],
        cancel_cb: Callable[[ServerGoalHandle], object] = nop_cb,
        auto_start: bool = True,
    ) -> None:
        self.ns = ns
        ActionTypes(ActionSpec).give_to(self)
        self.goal_sub: Any = None
        self.cancel_sub: Any = None
        self.status_pub: Any = None
        self.result_pub: Any = None
        self.feedback_pub: Any = None
        self.status_timer: Any = None
        self.lock = threading.RLock()
        self.status_list: list[StatusTracker] = []
        self.last_cancel = rospy.Time()
        self.status_list_timeout = rospy.Duration()
        self.id_generator = GoalIDGenerator()
        self.goal_callback = goal_cb
        self.cancel_callback = cancel_cb
        self.auto_start = auto_start
        self.started = False
        if auto_start:
            rospy.logwarn(
                "You've passed in true for auto_start to the python action server, you should always pass in false "
                "to avoid race conditions."
            )
            self.start()

    def register_goal_callback(self, cb: Callable[[ServerGoalHandle], object]) -> None:
        """Have new goals go to `cb`."""
        self.goal_callback = cb

    def register_cancel_callback(self, cancel_cb: Callable[[ServerGoalHandle], object]) -> None:
        """Have cancel requests go to `cancel_cb`."""
        self.cancel_callback = cancel_cb

    # -- topics --------------------------------------------------------------------------------------------------

    def start(self) -> None:
        """Open the topics and begin to work."""
        with self.lock:
            self.initialize()
            self.started = True
            self.publish_status()

    def stop(self) -> None:
        """Leave the topics. No goal should be active."""
        with self.lock:
            self.started = False
            if self.status_timer is not None:
                self.status_timer.shutdown()
            for each in (self.goal_sub, self.cancel_sub, self.status_pub, self.feedback_pub, self.result_pub):
                each.unregister()

    def initialize(self) -> None:
        """Open the topics and start the timer of the status."""
        size = rospy.get_param("actionlib_server_pub_queue_size", 50)
        self.pub_queue_size = 50 if size < 0 else size
        self.status_pub = self.__publisher("status", GoalStatusArray, latch=True)
        self.result_pub = self.__publisher("result", self.ActionResult)
        self.feedback_pub = self.__publisher("feedback", self.ActionFeedback)
        size = rospy.get_param("actionlib_server_sub_queue_size", -1)
        self.sub_queue_size = None if size < 0 else size
        self.goal_sub = self.__subscriber("goal", self.ActionGoal, self.internal_goal_callback)
        self.cancel_sub = self.__subscriber("cancel", GoalID, self.internal_cancel_callback)
        self.status_frequency = self.__status_frequency()
        self.status_list_timeout = rospy.Duration(rospy.get_param(self.__name("status_list_timeout"), 5.0))
        if self.status_frequency > 0:
            period = rospy.Duration(1.0 / self.status_frequency)
            self.status_timer = rospy.Timer(period, self.publish_status_async)

    def __name(self, part: str) -> str:
        return f"{rospy.remap_name(self.ns)}/{part}"

    def __publisher(self, part: str, kind: Any, **options: Any) -> Any:
        return rospy.Publisher(self.__name(part), kind, queue_size=self.pub_queue_size, **options)

    def __subscriber(self, part: str, kind: Any, callback: Callable[[Any], object]) -> Any:
        return rospy.Subscriber(self.__name(part), kind, callback=callback, queue_size=self.sub_queue_size)

    def __status_frequency(self) -> float:
        old = self.__name("status_frequency")
        if rospy.has_param(old):
            rospy.logwarn(
                "You're using the deprecated status_frequency parameter, please switch to actionlib_status_frequency."
            )
            return float(rospy.get_param(old, 5.0))
        name = rospy.search_param("actionlib_status_frequency")
        return 5.0 if name is None else float(rospy.get_param(name, 5.0))

    # -- publishing ----------------------------------------------------------------------------------------------

    def publish_result(self, status: Any, result: Any) -> None:
        """Publish the result of a goal, then all statuses."""
        with self.lock:
            self.__send(self.result_pub, self.ActionResult(status=status, result=result))
            self.publish_status()

    def publish_feedback(self, status: Any, feedback: Any) -> None:
        """Publish feedback on a goal."""
        with self.lock:
            self.__send(self.feedback_pub, self.ActionFeedback(status=status, feedback=feedback))

    def publish_status_async(self, event: object) -> None:
        """Publish all statuses on the timer."""
        with self.lock:
            if self.started:
                self.publish_status()

    def publish_status(self) -> None:
        """Publish all statuses, except for goals that ended some time ago."""
        with self.lock:
            now = rospy.Time.now()
            oldest_ns = now.to_nsec() - self.status_list_timeout.to_nsec()
            self.status_list[:] = [tracker for tracker in self.status_list if not _is_over(tracker, now, oldest_ns)]
            statuses = [tracker.status for tracker in self.status_list]
            self.__send(self.status_pub, GoalStatusArray(status_list=statuses))

    def __send(self, publisher: Any, message: Any) -> None:
        message.header.stamp = rospy.Time.now()
        if not rospy.is_shutdown():
            publisher.publish(message)

    # -- receiving -----------------------------------------------------------------------------------------------

    def internal_goal_callback(self, goal: Any) -> None:
        """A goal came, as an *ActionGoal message."""
        with self.lock:
            if not self.started:
                return
            rospy.logdebug("The action server has received a new goal request")
            for tracker in self.status_list:
                if goal.goal_id.id == tracker.status.goal_id.id:
                    self.__goal_again(tracker)
                    return
            tracker = StatusTracker(None, None, goal)
            self.status_list.append(tracker)
            handle = self.__handle(tracker)
            if goal.goal_id.stamp != rospy.Time() and goal.goal_id.stamp <= self.last_cancel:
                handle.set_canceled(None, _TOO_LATE)
            else:
                self.goal_callback(handle)

    def __handle(self, tracker: StatusTracker) -> ServerGoalHandle:
        tracker.handle_tracker = tracker.handle_tracker or HandleTrackerDeleter(self, tracker)
        return ServerGoalHandle(tracker, self, tracker.handle_tracker)

    def __goal_again(self, tracker: StatusTracker) -> None:
        """A goal came twice, or after the request to cancel it."""
        status = tracker.status
        rospy.logdebug("Goal %s was already in the status list with status %i", status.goal_id.id, status.status)
        if status.status == GoalStatus.RECALLING:
            status.status = GoalStatus.RECALLED
            self.publish_result(status, self.ActionResultType())
        if tracker.handle_tracker is None:
            tracker.handle_destruction_time = rospy.Time.now()

    def internal_cancel_callback(self, goal_id: Any) -> None:
        """A cancel request came, for one goal, those up to a time, or all."""
        with self.lock:
            if not self.started:
                return
            rospy.logdebug("The action server has received a new cancel request")
            known = any(goal_id.id == tracker.status.goal_id.id for tracker in self.status_list)
            for tracker in self.status_list[:]:
                if _is_meant(goal_id, tracker.status.goal_id):
                    self.__cancel(tracker)
            if goal_id.id != "" and not known:
                # The goal may still be on its way.
                tracker = StatusTracker(goal_id, GoalStatus.RECALLING)
                tracker.handle_destruction_time = rospy.Time.now()
                self.status_list.append(tracker)
            self.last_cancel = max(self.last_cancel, goal_id.stamp)

    def __cancel(self, tracker: StatusTracker) -> None:
        if tracker.handle_tracker is None:
            tracker.handle_destruction_time = rospy.Time.now()
        handle = self.__handle(tracker)
        if handle.set_cancel_requested():
            self.cancel_callback(handle)


def _is_meant(request: Any, goal_id: Any) -> bool:
    if request.id == goal_id.id or (request.id == "" and request.stamp == rospy.Time()):
        return True
    return bool(request.stamp != rospy.Time() and goal_id.stamp <= request.stamp)
