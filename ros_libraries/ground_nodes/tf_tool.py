"""tf's command line tools tf_echo and view_frames (wiki.ros.org/tf/Debugging_tools)."""

from __future__ import annotations

import json
import math
import time
from collections.abc import Sequence
from typing import Any

import rospy
import tf2_ros
import yaml
from tf.linear_math.matrix3x3 import Matrix3x3
from tf.linear_math.quaternion import Quaternion

WAIT_S = 1.0  # how long tf_echo waits before it complains


def main(words: Sequence[str]) -> None:
    """Execute a command line.

    Args:
        words: `echo FRAME FRAME HZ [COUNT]`, or `frames SECONDS`.
    """
    action, *rest = words
    (echo if action == "echo" else frames)(*rest)


# -- echo --------------------------------------------------------------------------------------------------------------


def echo(source: str, target: str, rate_hz: str, count: str = "") -> None:
    """Print the transform between two frames at a rate, as tf_echo does.

    Args:
        source: the frame of the observer.
        target: the frame whose pose it prints.
        rate_hz: how often.
        count: end after this many; without it, end when the node is shut down.
    """
    rospy.init_node("tf_echo", anonymous=True)
    buffer = tf2_ros.Buffer(debug=False)
    listener = tf2_ros.TransformListener(buffer)
    rate, shown = rospy.Rate(float(rate_hz)), 0
    buffer.can_transform(source, target, rospy.Time(), rospy.Duration(WAIT_S))
    while not rospy.is_shutdown() and str(shown) != count:
        try:
            print(_text(buffer.lookup_transform(source, target, rospy.Time())))
            shown += 1
        except tf2_ros.TransformException as error:
            now = rospy.Time.now()
            print(f"Failure at {now.secs}.{now.nsecs:09d}")
            print(f"Exception thrown:{error}\nThe current list of frames is:\n{buffer.all_frames_as_string()}")
        rate.sleep()
    listener.unregister()


def _text(found: Any) -> str:
    """Return a transform as tf_echo shows it."""
    moved, turned = found.transform.translation, found.transform.rotation
    angles = Matrix3x3(Quaternion(turned.x, turned.y, turned.z, turned.w)).getRPY()
    return "\n".join(
        [
            f"At time {found.header.stamp.to_sec():.3f}",
            f"- Translation: {_numbers(moved.x, moved.y, moved.z)}",
            f"- Rotation: in Quaternion {_numbers(turned.x, turned.y, turned.z, turned.w)}",
            f"            in RPY (radian) {_numbers(*angles)}",
            f"            in RPY (degree) {_numbers(*(math.degrees(angle) for angle in angles))}",
        ]
    )


def _numbers(*values: float) -> str:
    return "[" + ", ".join(f"{value:.3f}" for value in values) + "]"


# -- frames ------------------------------------------------------------------------------------------------------------


def frames(until_s: str) -> None:
    """Listen to transforms, then print one line of JSON: the graph that view_frames writes, and the data in it.

    Args:
        until_s: virtual second at which to print.
    """
    rospy.init_node("view_frames", anonymous=True)
    buffer = tf2_ros.Buffer(debug=False)
    listener = tf2_ros.TransformListener(buffer)
    time.sleep(max(0.0, float(until_s) - time.monotonic()))
    found = yaml.safe_load(buffer.all_frames_as_yaml())
    print(json.dumps({"dot": buffer._allFramesAsDot(rospy.Time.now()), "frames": found}))
    listener.unregister()
