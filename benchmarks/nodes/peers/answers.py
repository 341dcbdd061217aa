#!/usr/bin/env python3
"""Sends back each JointState that it receives."""

import rospy
from sensor_msgs.msg import JointState

rospy.init_node("answers")
publisher = rospy.Publisher("answer", JointState, queue_size=1)
rospy.Subscriber("question", JointState, publisher.publish, tcp_nodelay=True)
rospy.spin()
