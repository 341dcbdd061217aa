"""Moves an arm as an action. A preempt callback raises a flag; the flag is lowered when a goal begins."""

import threading

import actionlib
import rospy
from actionlib_tutorials.msg import FibonacciAction, FibonacciResult


class Arm:
    def __init__(self) -> None:
        self.stopped = threading.Event()
        self.server = actionlib.SimpleActionServer("move", FibonacciAction, self.execute, auto_start=False)
        self.server.register_preempt_callback(self.stopped.set)
        self.server.start()

    def execute(self, goal: object) -> None:
        self.stopped.clear()
        rospy.loginfo("moving")
        if self.stopped.wait(1.0):
            self.server.set_preempted()
        else:
            self.server.set_succeeded(FibonacciResult())


rospy.init_node("arm_server")
Arm()
rospy.spin()
