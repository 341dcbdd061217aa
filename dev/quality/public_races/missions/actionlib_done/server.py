"""Answers each goal at once."""

import actionlib
import rospy
from actionlib_tutorials.msg import FibonacciAction, FibonacciResult

rospy.init_node("server")


def execute(goal):
    server.set_succeeded(FibonacciResult([goal.order]))


server = actionlib.SimpleActionServer("fibonacci", FibonacciAction, execute, auto_start=False)
server.start()
rospy.spin()
