#!/usr/bin/env python3
"""Bursts of numbers, then one at a time."""

import rospy
from std_msgs.msg import Int32

if __name__ == "__main__":
    rospy.init_node("stimulus")
    into = rospy.Publisher("in", Int32, queue_size=30)
    rospy.sleep(3.02)
    for burst in range(2):
        for number in range(12):
            into.publish(100 * burst + number)
        rospy.sleep(1)
    for number in range(40):
        into.publish(1000 + number)
        rospy.sleep(0.1)
