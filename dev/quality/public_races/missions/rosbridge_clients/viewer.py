"""Reads the number of clients. The last one that is published must be 3."""

import sys

import rospy
from std_msgs.msg import Int32

rospy.init_node("viewer")
seen = []
rospy.Subscriber("client_count", Int32, lambda message: seen.append(message.data))
rospy.sleep(1)
if seen and seen[-1] != 3:
    sys.exit(f"three clients are there, and the last number of clients is {seen[-1]}")
