#!/usr/bin/env python3
"""Tells a node to call exit() after three seconds."""

import rospy
from std_msgs.msg import String

if __name__ == "__main__":
    rospy.init_node("ender")
    into = rospy.Publisher("in", String, queue_size=1)
    rospy.sleep(3)
    into.publish(f"exit {rospy.myargv()[1]}")
    rospy.spin()
