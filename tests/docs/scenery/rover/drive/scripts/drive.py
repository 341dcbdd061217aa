#!/usr/bin/env python3
"""Drives with a speed that has no type."""

import rospy
from drive.msg import Speed

rospy.init_node("drive")
rospy.Publisher("speed", Speed, queue_size=1)
rospy.spin()
