#!/usr/bin/env python3
"""Listens to what `frames.py` says."""

import rospy
from std_msgs.msg import String

rospy.init_node("ear")
rospy.Subscriber("chatter", String, lambda message: None)
rospy.spin()
