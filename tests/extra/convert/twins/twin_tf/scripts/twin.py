#!/usr/bin/env python3
"""The twin of src/twin.cpp."""

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped


def transform(parent, child, x):
    made = TransformStamped()
    made.header.stamp = rospy.Time.now()
    made.header.frame_id = parent
    made.child_frame_id = child
    made.transform.translation.x = x
    made.transform.rotation.z = 0.6
    made.transform.rotation.w = 0.8
    return made


if __name__ == "__main__":
    rospy.init_node("twin")
    out = rospy.Publisher("out", TransformStamped, queue_size=10)
    buffer = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(buffer)
    broadcaster = tf2_ros.TransformBroadcaster()
    still = tf2_ros.StaticTransformBroadcaster()
    rospy.sleep(1)
    still.sendTransform(transform("tool", "tip", 0.5))
    for number in range(20):
        broadcaster.sendTransform(transform("world", "base", number * 0.25))
        broadcaster.sendTransform(transform("base", "tool", 1.0))
        rospy.sleep(0.2)
        if buffer.can_transform("world", "tip", rospy.Time(0)):
            found = buffer.lookup_transform("world", "tip", rospy.Time(0))
            found.header.stamp = rospy.Time()
            out.publish(found)
    rospy.spin()
