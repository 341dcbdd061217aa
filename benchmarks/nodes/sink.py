#!/usr/bin/env python3
"""Receives JointStates and reads one field."""

import rospy
from sensor_msgs.msg import JointState

seen = []


def on_joints(message):
    seen[:] = message.position


rospy.init_node("sink")
rospy.Subscriber("joints", JointState, on_joints)
rospy.spin()
