"""Starts a movement and stops it again."""

import sys
import threading

import actionlib
import rospy
from actionlib_tutorials.msg import FibonacciAction, FibonacciGoal

rospy.init_node("operator")
client = actionlib.SimpleActionClient("move", FibonacciAction)
client.wait_for_server()
moving = threading.Event()
client.send_goal(FibonacciGoal(order=3), active_cb=moving.set)
moving.wait()
client.cancel_goal()
if not client.wait_for_result(rospy.Duration(0.2)):
    sys.exit("the arm does not stop")
