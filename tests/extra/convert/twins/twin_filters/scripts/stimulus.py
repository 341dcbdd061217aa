#!/usr/bin/env python3
"""Pairs of messages and lonely ones, from one seed; times do not go back, where rospy and roscpp pair otherwise."""

import random

import rospy
from geometry_msgs.msg import PoseStamped
from sensor_msgs.msg import Imu
from std_msgs.msg import Header

if __name__ == "__main__":
    rospy.init_node("stimulus")
    dice = random.Random(3)
    into = (rospy.Publisher("imu", Imu, queue_size=10), rospy.Publisher("pose", PoseStamped, queue_size=10))
    rospy.sleep(2)
    for cycle in range(60):
        for side in dice.sample((0, 1), 2):
            header = Header(stamp=rospy.Time(100 + cycle, 5), frame_id=f"{side} {cycle}")
            if dice.random() < 0.7:
                into[side].publish(Imu(header=header) if side == 0 else PoseStamped(header=header))
            rospy.sleep(0.02)
        rospy.sleep(0.05)
