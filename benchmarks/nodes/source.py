#!/usr/bin/env python3
"""Publishes JointStates of seven joints as fast as its subscriber allows, in bursts that fit into its queue."""

import rospy
from sensor_msgs.msg import JointState

BURST = 40

rospy.init_node("source")
publisher = rospy.Publisher("joints", JointState, queue_size=BURST)
message = JointState(name=[f"joint_{number}" for number in range(7)])
message.position = message.velocity = message.effort = [0.1 * number for number in range(7)]
rate = rospy.Rate(1000)
while not rospy.is_shutdown():
    for _ in range(BURST):
        publisher.publish(message)
    rate.sleep()
