"""tf/static_transform_publisher: one fixed transform, sent on /tf again and again.

Arguments: x y z, then qx qy qz qw or yaw pitch roll, then frame, child frame and period in ms. Each transform is
dated as far into the future as the next one is away. Source: wiki.ros.org/tf#static_transform_publisher.
"""

from __future__ import annotations

import sys

import rospy
import tf
from tf.transformations import quaternion_from_euler

USAGE = """usage: static_transform_publisher x y z qx qy qz qw frame_id child_frame_id period_in_ms
   or: static_transform_publisher x y z yaw pitch roll frame_id child_frame_id period_in_ms"""


def main() -> int:
    """Publish it until the end."""
    rospy.init_node("static_transform_publisher", anonymous=True)
    words = rospy.myargv()[1:]
    if len(words) not in (9, 10):
        rospy.logerr("%d arguments\n%s", len(words), USAGE)
        return 1
    *numbers, frame, child, milliseconds = words
    try:
        values, period = [float(word) for word in numbers], rospy.Duration(float(milliseconds) / 1000)
    except ValueError as error:
        rospy.logerr("%s\n%s", error, USAGE)
        return 1
    if len(values) == 6:
        yaw, pitch, roll = values[3:]
        values[3:] = quaternion_from_euler(roll, pitch, yaw)
    broadcaster = tf.TransformBroadcaster()
    while not rospy.is_shutdown():
        broadcaster.sendTransform(values[:3], values[3:], rospy.Time.now() + period, child, frame)
        rospy.sleep(period)
    return 0


if __name__ == "__main__":
    try:
        sys.exit(main())
    except rospy.ROSInterruptException:
        sys.exit(0)
