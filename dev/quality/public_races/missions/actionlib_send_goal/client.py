"""Sends one goal after another. Each must have a result."""

import sys

import actionlib
import rospy
from actionlib_tutorials.msg import FibonacciAction, FibonacciGoal

GOALS = 3
rospy.init_node("client")
client = actionlib.SimpleActionClient("fibonacci", FibonacciAction)
client.wait_for_server()
for number in range(GOALS):
    client.send_goal(FibonacciGoal(order=number))
    if not client.wait_for_result(rospy.Duration(2)):
        sys.exit(f"goal {number} has no result after 2 s")
