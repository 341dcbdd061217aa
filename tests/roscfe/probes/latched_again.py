#!/usr/bin/env python3
"""Latches a message, says another when it is asked to, and subscribes to numbers for a while."""

import rospy
from std_msgs.msg import Int32, String


def wait_for(name):
    while not rospy.is_shutdown() and not rospy.has_param(name):
        rospy.sleep(0.05)


rospy.init_node("partner")
latched = rospy.Publisher("/latched", String, latch=True, queue_size=10)
latched.publish("one")
numbers = rospy.Subscriber("/numbers", Int32, lambda message: None)
rospy.set_param("/ready", 1)
wait_for("/say")
latched.publish("two")
wait_for("/leave")
numbers.unregister()
rospy.set_param("/left", 1)
wait_for("/end")
