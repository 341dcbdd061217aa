"""Sends a second goal while the first one ends. The wait must be for the second goal."""

import sys

import actionlib
import rospy
from actionlib_msgs.msg import GoalStatus
from actionlib_tutorials.msg import FibonacciAction, FibonacciGoal

rospy.init_node("client")
client = actionlib.SimpleActionClient("fibonacci", FibonacciAction)
client.wait_for_server()
client.send_goal(FibonacciGoal(order=1))
rospy.sleep(0.02)
client.send_goal(FibonacciGoal(order=2))
if client.wait_for_result(rospy.Duration(1)) and client.get_state() in (GoalStatus.PENDING, GoalStatus.ACTIVE):
    sys.exit("the wait for the second goal has ended, and the goal has not")
