#!/usr/bin/env python3
"""Calls a service repeatedly; with the argument "persistent" over one connection."""

import sys

import rospy
from rospy_tutorials.srv import AddTwoInts

rospy.init_node("caller")
rospy.wait_for_service("add")
add = rospy.ServiceProxy("add", AddTwoInts, persistent="persistent" in sys.argv)
rospy.sleep(1.0)
while not rospy.is_shutdown():
    if add(20, 22).sum != 42:
        raise ValueError("wrong sum")
