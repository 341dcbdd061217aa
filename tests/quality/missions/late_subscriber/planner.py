"""Waits for the one goal that comes at the start, and plans."""

import sys
import threading

import rospy
from std_msgs.msg import Float32

rospy.init_node("planner")
arrived = threading.Event()
rospy.Subscriber("goal", Float32, lambda message: arrived.set())
if not arrived.wait(0.2):
    sys.exit("no goal came")
rospy.loginfo("planning")
