"""Answers each request for a transform at once."""

import actionlib
import rospy
from tf2_msgs.msg import LookupTransformAction, LookupTransformResult

rospy.init_node("server")


def execute(goal):
    server.set_succeeded(LookupTransformResult())


server = actionlib.SimpleActionServer("tf2_buffer_server", LookupTransformAction, execute, auto_start=False)
server.start()
rospy.spin()
