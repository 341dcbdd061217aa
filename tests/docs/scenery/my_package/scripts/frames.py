#!/usr/bin/env python3
"""Says where base_link is in map."""

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped

rospy.init_node("frames")
broadcaster = tf2_ros.TransformBroadcaster()
rate = rospy.Rate(10)
while not rospy.is_shutdown():
    transform = TransformStamped()
    transform.header.stamp = rospy.Time.now()
    transform.header.frame_id = "map"
    transform.child_frame_id = "base_link"
    transform.transform.rotation.w = 1
    broadcaster.sendTransform(transform)
    rate.sleep()
