"""`BufferServer`: offers a buffer's transforms as the action that `BufferClient` uses (buffer_server.h of tf2_ros).

ROS has it in C++ only. Imports rospy, actionlib, tf2_msgs and tf2_py.
"""

from __future__ import annotations

from typing import Any

import actionlib
import rospy
from tf2_msgs.msg import LookupTransformAction, LookupTransformResult, TF2Error
from tf2_py import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)

_CODES: dict[type[TransformException], int] = {
    LookupException: TF2Error.LOOKUP_ERROR,
    ConnectivityException: TF2Error.CONNECTIVITY_ERROR,
    ExtrapolationException: TF2Error.EXTRAPOLATION_ERROR,
    InvalidArgumentException: TF2Error.INVALID_ARGUMENT_ERROR,
    TimeoutException: TF2Error.TIMEOUT_ERROR,
}


class BufferServer:
    """Answers goals when their transform is available, at the latest after their timeout.

    Args:
        buffer: the buffer with the transforms.
        ns: namespace of the action.
        auto_start: take goals at once; otherwise call `start`.
        check_period: how often to look for the transforms of waiting goals, a rospy.Duration; None for 10 ms.
    """

    def __init__(self, buffer: Any, ns: str, auto_start: bool = True, check_period: Any = None) -> None:
        self._buffer = buffer
        self._waiting: list[tuple[Any, Any]] = []  # handles of goals, and when they end
        self._server = actionlib.ActionServer(ns, LookupTransformAction, self._goal, self._cancel, auto_start=False)
        self._timer = rospy.Timer(rospy.Duration(0, 10_000_000) if check_period is None else check_period, self._check)
        if auto_start:
            self.start()

    def start(self) -> None:
        """Take goals."""
        self._server.start()

    def _goal(self, handle: Any) -> None:
        handle.set_accepted("Accepted")
        end = rospy.Time.now() + handle.get_goal().timeout
        if not self._answer(handle, end):
            self._waiting.append((handle, end))

    def _cancel(self, handle: Any) -> None:
        if any(waiting == handle for waiting, _ in self._waiting):
            self._waiting = [(waiting, end) for waiting, end in self._waiting if waiting != handle]
            handle.set_canceled()

    def _check(self, event: Any) -> None:
        for waiting in self._waiting[:]:
            if waiting in self._waiting and self._answer(*waiting):
                self._waiting.remove(waiting)

    def _answer(self, handle: Any, end: Any) -> bool:
        """Answer a goal if its transform is there or its time is over."""
        result = LookupTransformResult()
        try:
            result.transform = self._lookup(handle.get_goal())
        except TransformException as problem:
            if rospy.Time.now() < end:
                return False
            result.error.error = _CODES.get(type(problem), TF2Error.TRANSFORM_ERROR)
            result.error.error_string = str(problem)
        handle.set_succeeded(result)
        return True

    def _lookup(self, goal: Any) -> Any:
        target, source = goal.target_frame, goal.source_frame
        if not goal.advanced:
            return self._buffer.lookup_transform(target, source, goal.source_time)
        return self._buffer.lookup_transform_full(target, goal.target_time, source, goal.source_time, goal.fixed_frame)
