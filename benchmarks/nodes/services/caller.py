#!/usr/bin/env python3
"""Calls a service again and again; with the argument "persistent" through a connection that stays."""

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
