#!/usr/bin/env python3
"""Broadcasts world -> base, turned, at 10 Hz, and base -> camera once; talks, and offers a service."""

import math

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from std_msgs.msg import String
from std_srvs.srv import Trigger, TriggerResponse


def transform(parent, child, x, angle):
    found = TransformStamped()
    found.header.stamp = rospy.Time.now()
    found.header.frame_id = parent
    found.child_frame_id = child
    found.transform.translation.x = x
    found.transform.rotation.z = math.sin(angle / 2)
    found.transform.rotation.w = math.cos(angle / 2)
    return found


rospy.init_node("frames")
rospy.Service("flip", Trigger, lambda request: TriggerResponse(True, "flipped"))
fixed = tf2_ros.StaticTransformBroadcaster()
fixed.sendTransform(transform("base", "camera", 0.1, 0.0))
moving = tf2_ros.TransformBroadcaster()
talker = rospy.Publisher("chatter", String, queue_size=10)
rospy.Subscriber("orders", String, lambda message: None)
rate = rospy.Rate(10)
while not rospy.is_shutdown():
    moving.sendTransform(transform("world", "base", 2.0, math.pi / 2))
    talker.publish("hi")
    rate.sleep()
