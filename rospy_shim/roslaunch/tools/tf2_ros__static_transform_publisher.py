"""tf2_ros/static_transform_publisher: one fixed transform, latched on /tf_static.

Arguments: x y z, then qx qy qz qw or yaw pitch roll, then frame and child frame; or the name of a parameter that holds
a transform. Source: wiki.ros.org/tf2_ros#static_transform_publisher.
"""

from __future__ import annotations

import sys
from typing import Any

import rospy
from geometry_msgs.msg import TransformStamped
from tf.transformations import quaternion_from_euler
from tf2_ros import StaticTransformBroadcaster

USAGE = """usage: static_transform_publisher x y z qx qy qz qw frame_id child_frame_id
   or: static_transform_publisher x y z yaw pitch roll frame_id child_frame_id
   or: static_transform_publisher /param_name"""


def from_numbers(words: list[str]) -> TransformStamped:
    """Return the transform of a command line of eight or nine words.

    Raises:
        ValueError: a word that should be a number.
    """
    *numbers, frame, child = words
    values = [float(word) for word in numbers]
    if len(values) == 6:
        yaw, pitch, roll = values[3:]
        values[3:] = quaternion_from_euler(roll, pitch, yaw)
    return transform(frame, child, values)


def from_param(name: str) -> TransformStamped:
    """Return the transform in a parameter: header/frame_id, child_frame_id, transform/translation and /rotation.

    Raises:
        KeyError: a part of it is missing.
    """
    tree: dict[str, Any] = rospy.get_param(name)
    inner = tree["transform"]
    values = [inner["translation"][axis] for axis in "xyz"] + [inner["rotation"][axis] for axis in "xyzw"]
    return transform(tree["header"]["frame_id"], tree["child_frame_id"], values)


def transform(frame: str, child: str, values: list[float]) -> TransformStamped:
    """Make a message from a translation in m and a quaternion."""
    stamped = TransformStamped()
    stamped.header.stamp = rospy.Time.now()
    stamped.header.frame_id, stamped.child_frame_id = frame, child
    place, turn = stamped.transform.translation, stamped.transform.rotation
    place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w = values
    return stamped


def main() -> int:
    """Publish it, and run until the end."""
    rospy.init_node("static_transform_publisher", anonymous=True)
    words = rospy.myargv()[1:]
    if len(words) not in (1, 8, 9):
        rospy.logerr("%d arguments\n%s", len(words), USAGE)
        return 1
    try:
        stamped = from_param(words[0]) if len(words) == 1 else from_numbers(words)
    except (KeyError, ValueError) as error:
        rospy.logerr("%s\n%s", error, USAGE)
        return 1
    if stamped.header.frame_id == stamped.child_frame_id:
        rospy.logerr("frame_id and child_frame_id are both %s", stamped.child_frame_id)
        return 1
    broadcaster = StaticTransformBroadcaster()
    broadcaster.sendTransform(stamped)
    rospy.spin()
    return 0


if __name__ == "__main__":
    sys.exit(main())
