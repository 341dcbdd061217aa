"""`Buffer`: a node's own buffer of transforms, which can wait for them in ROS time (tf2_ros.buffer).

Imports rospy, tf2_msgs and tf2_py.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import rospy
from tf2_msgs.srv import FrameGraph, FrameGraphResponse
from tf2_py import BufferCore

from tf2_ros.buffer_interface import _NO_WAIT, BufferInterface

DEFAULT_CAN_TRANSFORM_POLLING_SCALE = 0.01
_BIG_JUMP = rospy.Duration(3.0)  # of the clock backwards, after which waiting makes no sense


class Buffer(BufferCore, BufferInterface):
    """A buffer of transforms.

    Args:
        cache_time: how long samples are kept, a rospy.Duration; None for 10 s.
        debug: offer the service ~tf2_frames, which returns the frames as YAML, unless the node has it already.
    """

    def __init__(self, cache_time: Any = None, debug: bool = True) -> None:
        BufferCore.__init__(self, cache_time)
        BufferInterface.__init__(self)
        self.CAN_TRANSFORM_POLLING_SCALE = DEFAULT_CAN_TRANSFORM_POLLING_SCALE
        if debug:
            self.__offer_frames()

    def __offer_frames(self) -> None:
        try:
            self.frame_server = rospy.Service("~tf2_frames", FrameGraph, self.__frames)
        except rospy.ServiceException:
            return  # an earlier buffer of this node offers it

    def __frames(self, request: Any) -> Any:
        return FrameGraphResponse(self.all_frames_as_yaml())

    def lookup_transform(self, target_frame: str, source_frame: str, time: Any, timeout: Any = _NO_WAIT) -> Any:
        """Return the transform that takes coordinates in the source frame to the target frame.

        Args:
            target_frame: name of a frame.
            source_frame: name of a frame.
            time: a rospy.Time; 0 for the latest common one.
            timeout: how long to wait for it, a rospy.Duration.

        Returns:
            a geometry_msgs/TransformStamped.

        Raises:
            LookupException, ConnectivityException, ExtrapolationException, InvalidArgumentException: it is not
                available.
        """
        if timeout != _NO_WAIT:
            self.can_transform(target_frame, source_frame, time, timeout)
        return self.lookup_transform_core(target_frame, source_frame, time)

    def lookup_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Any = _NO_WAIT,
    ) -> Any:
        """Return the transform from the source frame at one time to the target frame at another.

        Args:
            target_frame: name of a frame.
            target_time: a rospy.Time; 0 for the latest.
            source_frame: name of a frame.
            source_time: a rospy.Time; 0 for the latest.
            fixed_frame: the frame that does not move in between.
            timeout: how long to wait for it, a rospy.Duration.

        Returns:
            a geometry_msgs/TransformStamped.

        Raises:
            LookupException, ConnectivityException, ExtrapolationException, InvalidArgumentException: as
                `lookup_transform`.
        """
        if timeout != _NO_WAIT:
            self.can_transform_full(target_frame, target_time, source_frame, source_time, fixed_frame, timeout)
        return self.lookup_transform_full_core(target_frame, target_time, source_frame, source_time, fixed_frame)

    def can_transform(
        self,
        target_frame: str,
        source_frame: str,
        time: Any,
        timeout: Any = _NO_WAIT,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Return whether `lookup_transform` would succeed.

        Args:
            target_frame: name of a frame.
            source_frame: name of a frame.
            time: a rospy.Time; 0 for the latest common one.
            timeout: how long to wait until it would, a rospy.Duration.
            return_debug_tuple: also return the reason if not.

        Returns:
            1 or 0; or that and a text.
        """

        def ask() -> tuple[int, str]:
            return self.can_transform_core(target_frame, source_frame, time)

        found = self.__wait(ask, timeout)
        return found if return_debug_tuple else found[0]

    def can_transform_full(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Any = _NO_WAIT,
        return_debug_tuple: bool = False,
    ) -> Any:
        """Return whether `lookup_transform_full` would succeed.

        It has the arguments of that, and the rest as `can_transform`.
        """

        def ask() -> tuple[int, str]:
            return self.can_transform_full_core(target_frame, target_time, source_frame, source_time, fixed_frame)

        found = self.__wait(ask, timeout)
        return found if return_debug_tuple else found[0]

    def __wait(self, ask: Callable[[], tuple[int, str]], timeout: Any) -> tuple[int, str]:
        """Ask again and again until the answer is yes or the time is over."""
        if timeout == _NO_WAIT:
            return ask()
        start = rospy.Time.now()
        pause = timeout * self.CAN_TRANSFORM_POLLING_SCALE
        while rospy.Time.now() < start + timeout and not ask()[0] and rospy.Time.now() + _BIG_JUMP >= start:
            rospy.sleep(pause)
        return ask()
