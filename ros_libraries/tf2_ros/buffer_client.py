"""`BufferClient`: asks a server of transforms instead of keeping a buffer (tf2_ros.buffer_client).

Imports rospy, actionlib, tf2_msgs and tf2_py.
"""

from __future__ import annotations

from typing import Any

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from tf2_msgs.msg import LookupTransformAction, LookupTransformGoal, TF2Error
from tf2_py import (
    ConnectivityException,
    ExtrapolationException,
    InvalidArgumentException,
    LookupException,
    TimeoutException,
    TransformException,
)

from tf2_ros.buffer_interface import _NO_WAIT, BufferInterface

_EXCEPTIONS: dict[int, type[TransformException]] = {
    TF2Error.LOOKUP_ERROR: LookupException,
    TF2Error.CONNECTIVITY_ERROR: ConnectivityException,
    TF2Error.EXTRAPOLATION_ERROR: ExtrapolationException,
    TF2Error.INVALID_ARGUMENT_ERROR: InvalidArgumentException,
    TF2Error.TIMEOUT_ERROR: TimeoutException,
}
_GOAL = "The LookupTransform goal sent to the BufferServer did not come back"
_PADDING = rospy.Duration(2)
_WRONG = "Something is likely wrong with the server"


class BufferClient(BufferInterface):
    """A source of transforms in another node.

    Args:
        ns: namespace of the server's action.
        check_frequency: without effect.
        timeout_padding: how much longer than the server to wait, a rospy.Duration.
    """

    def __init__(self, ns: str, check_frequency: Any = None, timeout_padding: Any = _PADDING) -> None:
        super().__init__()
        self.client = actionlib.SimpleActionClient(ns, LookupTransformAction)
        self.timeout_padding = timeout_padding
        if check_frequency is not None:
            rospy.logwarn("Argument check_frequency is deprecated and should not be used.")

    def wait_for_server(self, timeout: Any = _NO_WAIT) -> Any:
        """Wait until the server is available.

        Args:
            timeout: how long, a rospy.Duration; 0 forever.

        Returns:
            whether it is.
        """
        return self.client.wait_for_server(timeout)

    def lookup_transform(self, target_frame: str, source_frame: str, time: Any, timeout: Any = _NO_WAIT) -> Any:
        """Return the transform as `tf2_ros.Buffer.lookup_transform` does.

        Raises:
            TimeoutException: the server did not answer.
            TransformException: the server's error.
        """
        return self.__ask(
            LookupTransformGoal(
                target_frame=target_frame,
                source_frame=source_frame,
                source_time=time,
                timeout=timeout,
            )
        )

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Any = _NO_WAIT,
    ) -> Any:
        """Return the transform as `tf2_ros.Buffer.lookup_transform_full` does.

        Errors are those of `lookup_transform`.
        """
        return self.__ask(
            LookupTransformGoal(
                target_frame=target_frame,
                source_frame=source_frame,
                source_time=source_time,
                timeout=timeout,
                target_time=target_time,
                fixed_frame=fixed_frame,
                advanced=True,
            )
        )

    def can_transform(self, target_frame: str, source_frame: str, time: Any, timeout: Any = _NO_WAIT) -> bool:
        """Return whether `lookup_transform` succeeds."""
        try:
            self.lookup_transform(target_frame, source_frame, time, timeout)
        except TransformException:
            return False
        return True

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Any = _NO_WAIT,
    ) -> bool:
        """Return whether `lookup_transform_full` succeeds."""
        try:
            self.lookup_transform_full(target_frame, target_time, source_frame, source_time, fixed_frame, timeout)
        except TransformException:
            return False
        return True

    def __ask(self, goal: Any) -> Any:
        self.client.send_goal(goal)
        if not self.client.wait_for_result(goal.timeout + self.timeout_padding):
            raise TimeoutException(f"{_GOAL} in the specified time. {_WRONG}")
        if self.client.get_state() != GoalStatus.SUCCEEDED:
            raise TimeoutException(f"{_GOAL} with SUCCEEDED status. {_WRONG}.")
        result = self.client.get_result()
        if not result:
            raise TransformException(f"The BufferServer returned None for result!  {_WRONG}.")
        if result.error.error != TF2Error.NO_ERROR:
            raise _EXCEPTIONS.get(result.error.error, TransformException)(result.error.error_string)
        return result.transform
