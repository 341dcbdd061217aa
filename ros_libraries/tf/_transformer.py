"""`Transformer`: a tf2 buffer with tf's names of functions (tf.listener.Transformer).

Imports rospy and tf2_ros; NumPy, by way of `tf._twist`, when it is first needed.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import rospy
import tf2_ros

Numbers = list[float]
_NOT_LISTENING = "cannot wait for transform without a dedicated thread that listens to incoming TF messages"


def strip_leading_slash(s: str) -> str:
    """Return a frame's name as tf2 wants it."""
    return s.removeprefix("/")


class Transformer:
    """A buffer of transforms with tf's names of functions. Names of frames may begin with a slash.

    Args:
        interpolate: without effect, as in tf.
        cache_time: how long samples are kept, a rospy.Duration; None for 10 s.
    """

    def __init__(self, interpolate: bool = True, cache_time: Any = None) -> None:
        self._buffer = tf2_ros.Buffer(cache_time, debug=False)
        self._using_dedicated_thread = False

    def setTransform(self, transform: Any, authority: str = "default_authority") -> None:
        """Take in a geometry_msgs/TransformStamped."""
        self._buffer.set_transform(transform, authority)

    def clear(self) -> None:
        """Forget all transforms."""
        self._buffer.clear()

    def setUsingDedicatedThread(self, value: bool) -> None:
        """Declare that another thread fills the buffer, so that waiting makes sense."""
        self._using_dedicated_thread = value

    def getTFPrefix(self) -> str:
        """Always "": tf2 knows no prefixes."""
        return ""

    # -- frames ------------------------------------------------------------------------------------------------------

    def allFramesAsDot(self, current_time: Any = None) -> str:
        """Return the frames as a graph for dot; with a rospy.Time, include their ages."""
        return self._buffer._allFramesAsDot(current_time) if current_time else self._buffer._allFramesAsDot()

    def allFramesAsString(self) -> str:
        """Return a line for each frame that has a parent."""
        return self._buffer.all_frames_as_string()

    def frameExists(self, frame_id: str) -> bool:
        """Return whether a frame has a parent."""
        return frame_id in self.getFrameStrings()

    def getFrameStrings(self) -> list[str]:
        """Return the names of the frames that have a parent."""
        lines = self._buffer.all_frames_as_yaml().splitlines()
        return [line.removesuffix(": ") for line in lines if line.endswith(": ")]

    def chain(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> list[str]:
        """Return the frames on the way from the source frame, by way of the fixed one, to the target frame."""
        return self._buffer._chain(target_frame, target_time, source_frame, source_time, fixed_frame)

    # -- asking ------------------------------------------------------------------------------------------------------

    def canTransform(self, target_frame: str, source_frame: str, time: Any) -> Any:
        """Return whether `lookupTransform` would succeed: 1 or 0."""
        return self._buffer.can_transform(strip_leading_slash(target_frame), strip_leading_slash(source_frame), time)

    def canTransformFull(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> Any:
        """Return whether `lookupTransformFull` would succeed: 1 or 0."""
        target, source, fixed = map(strip_leading_slash, (target_frame, source_frame, fixed_frame))
        return self._buffer.can_transform_full(target, target_time, source, source_time, fixed)

    def waitForTransform(
        self, target_frame: str, source_frame: str, time: Any, timeout: Any, polling_sleep_duration: Any = None
    ) -> None:
        """Wait until `lookupTransform` would succeed.

        Args:
            target_frame: name of a frame.
            source_frame: name of a frame.
            time: a rospy.Time; 0 for the latest common one.
            timeout: how long to wait, a rospy.Duration.
            polling_sleep_duration: without effect, as in tf.

        Raises:
            tf.Exception: the time is over, or no thread fills the buffer.
        """
        self._require_listening()
        target, source = strip_leading_slash(target_frame), strip_leading_slash(source_frame)
        found = self._buffer.can_transform(target, source, time, timeout, return_debug_tuple=True)
        _require(found, target_frame, source_frame)

    def waitForTransformFull(
        self,
        target_frame: str,
        target_time: Any,
        source_frame: str,
        source_time: Any,
        fixed_frame: str,
        timeout: Any,
        polling_sleep_duration: Any = None,
    ) -> None:
        """Wait until `lookupTransformFull` would succeed.

        It has the arguments of that, and the rest as `waitForTransform`.
        """
        self._require_listening()
        target, source, fixed = map(strip_leading_slash, (target_frame, source_frame, fixed_frame))
        found = self._buffer.can_transform_full(
            target, target_time, source, source_time, fixed, timeout, return_debug_tuple=True
        )
        _require(found, target_frame, source_frame)

    def _require_listening(self) -> None:
        if not self._using_dedicated_thread:
            raise tf2_ros.TransformException(_NOT_LISTENING)

    # -- looking up --------------------------------------------------------------------------------------------------

    def getLatestCommonTime(self, source_frame: str, dest_frame: str) -> Any:
        """Return the latest time that all frames between two have in common, a rospy.Time."""
        return self._buffer.get_latest_common_time(strip_leading_slash(source_frame), strip_leading_slash(dest_frame))

    def lookupTransform(self, target_frame: str, source_frame: str, time: Any) -> tuple[Numbers, Numbers]:
        """Return the transform that takes coordinates in the source frame to the target frame.

        Args:
            target_frame: name of a frame.
            source_frame: name of a frame.
            time: a rospy.Time; 0 for the latest common one.

        Returns:
            translation [x, y, z] and rotation [x, y, z, w].

        Raises:
            tf.LookupException, tf.ConnectivityException, tf.ExtrapolationException: it is not available.
        """
        target, source = strip_leading_slash(target_frame), strip_leading_slash(source_frame)
        return _numbers(self._buffer.lookup_transform(target, source, time))

    def lookupTransformFull(
        self, target_frame: str, target_time: Any, source_frame: str, source_time: Any, fixed_frame: str
    ) -> tuple[Numbers, Numbers]:
        """Return the transform from the source frame at one time to the target frame at another.

        Args:
            target_frame: name of a frame.
            target_time: a rospy.Time.
            source_frame: name of a frame.
            source_time: a rospy.Time.
            fixed_frame: the frame that does not move in between.

        Returns:
            translation and rotation; errors as `lookupTransform`.
        """
        target, source, fixed = map(strip_leading_slash, (target_frame, source_frame, fixed_frame))
        return _numbers(self._buffer.lookup_transform_full(target, target_time, source, source_time, fixed))

    def lookupTwist(self, tracking_frame: str, observation_frame: str, time: Any, averaging_interval: Any) -> Any:
        """Return the velocity of a frame as seen from another. Arguments: see `lookupTwistFull`."""
        return self.lookupTwistFull(
            tracking_frame, observation_frame, observation_frame, (0, 0, 0), tracking_frame, time, averaging_interval
        )

    def lookupTwistFull(
        self,
        tracking_frame: str,
        observation_frame: str,
        reference_frame: str,
        ref_point: Sequence[float],
        reference_point_frame: str,
        time: Any,
        averaging_interval: Any,
    ) -> Any:
        """Return the velocity of a frame, from two of its poses.

        Args:
            tracking_frame: the moving frame.
            observation_frame: the frame of the observer.
            reference_frame: the frame in which the result is expressed.
            ref_point: without effect, as in tf.
            reference_point_frame: the linear velocity is the velocity of this frame's origin.
            time: the middle of the interval between the poses, a rospy.Time; 0 for the latest.
            averaging_interval: its length, a rospy.Duration.

        Returns:
            linear velocity (x, y, z) and angular velocity (x, y, z), per second; errors as `lookupTransform`.
        """
        from tf._twist import between_poses, shifted

        latest = self.getLatestCommonTime(observation_frame, tracking_frame)
        middle = time or latest
        end = min(middle + rospy.Duration(0.5 * averaging_interval.to_sec()), latest)
        start = max(rospy.Time(0.0001) + averaging_interval, end) - averaging_interval
        before = self.lookupTransform(observation_frame, tracking_frame, start)
        after = self.lookupTransform(observation_frame, tracking_frame, end)
        velocity = between_poses(before, after, (end - start).to_sec())
        tracked = self.lookupTransform(reference_frame, tracking_frame, middle)
        return shifted(velocity, tracked, self.lookupTransform(reference_frame, reference_point_frame, middle))


def _require(found: tuple[int, str], target: str, source: str) -> None:
    possible, problem = found
    if not possible:
        raise tf2_ros.TransformException(problem or f'no such transformation: "{source}" -> "{target}"')


def _numbers(message: Any) -> tuple[Numbers, Numbers]:
    t, r = message.transform.translation, message.transform.rotation
    return [t.x, t.y, t.z], [r.x, r.y, r.z, r.w]
