"""Sends a goal as soon as the client has found the server. It must have a result."""

import sys

import actionlib
import rospy
from actionlib_tutorials.msg import FibonacciAction, FibonacciGoal

rospy.init_node("client")
client = actionlib.SimpleActionClient("fibonacci", FibonacciAction)
client.wait_for_server()
client.send_goal(FibonacciGoal(order=1))
if not client.wait_for_result(rospy.Duration(1)):
    sys.exit("the goal has no result after 1 s")
