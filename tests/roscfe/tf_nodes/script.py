#!/usr/bin/env python3
"""Tells where an arm is on the robot, and looks where the robot is."""

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped

rospy.init_node("script")
buffer = tf2_ros.Buffer()
listener = tf2_ros.TransformListener(buffer)
broadcaster = tf2_ros.TransformBroadcaster()
rate = rospy.Rate(10)
while not rospy.is_shutdown():
    arm = TransformStamped(child_frame_id="python_arm")
    arm.header.frame_id, arm.header.stamp = "base_link", rospy.Time.now()
    arm.transform.translation.y, arm.transform.rotation.w = 3.0, 1.0
    broadcaster.sendTransform(arm)
    if buffer.can_transform("map", "a_sensor_with_a_long_name", rospy.Time(0)):
        found = buffer.lookup_transform("map", "a_sensor_with_a_long_name", rospy.Time(0))
        rospy.loginfo("python: %g %g", found.transform.translation.y, found.transform.translation.z)
    rate.sleep()
