#!/usr/bin/env python3
"""Offers a service that adds two numbers."""

import rospy
from rospy_tutorials.srv import AddTwoInts

rospy.init_node("adder")
rospy.Service("add", AddTwoInts, lambda request: request.a + request.b)
rospy.spin()
