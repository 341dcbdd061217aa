#!/usr/bin/env python3
"""Looks up a transform through a chain of ten frames, between two samples of each. Prints a line every 100 times."""

import math

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped

FRAMES, SAMPLES, LINE = 10, 100, 100

rospy.init_node("looker")
buffer = tf2_ros.Buffer(rospy.Duration(20), debug=False)
message = TransformStamped()
for number in range(FRAMES):
    message.header.frame_id, message.child_frame_id = f"frame{number}", f"frame{number + 1}"
    for sample in range(SAMPLES):
        message.header.stamp = rospy.Time(1000, sample * 10_000_000)
        message.transform.translation.x = 0.1 * sample
        message.transform.rotation.z, message.transform.rotation.w = math.sin(0.01 * sample), math.cos(0.01 * sample)
        buffer.set_transform(message, "looker")
rospy.sleep(1.0)
while not rospy.is_shutdown():
    for _ in range(LINE):
        buffer.lookup_transform("frame0", f"frame{FRAMES}", rospy.Time(1000, 455_000_000))
    print("looked")
