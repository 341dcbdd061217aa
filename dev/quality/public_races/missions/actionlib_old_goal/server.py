"""Works on each goal for 20 ms, unless a newer goal preempts it."""

import actionlib
import rospy
from actionlib_tutorials.msg import FibonacciAction, FibonacciResult

rospy.init_node("server")


def execute(goal):
    rospy.sleep(0.02)
    if server.is_preempt_requested():
        server.set_preempted(FibonacciResult([goal.order]))
    else:
        server.set_succeeded(FibonacciResult([goal.order]))


server = actionlib.SimpleActionServer("fibonacci", FibonacciAction, execute, auto_start=False)
server.start()
rospy.spin()
