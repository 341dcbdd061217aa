#!/usr/bin/env python3
"""The clock of the probe: from 100 s on, twice as quick as the wall, and back to 50 s when it is asked to."""

import time

import rospy
from rosgraph_msgs.msg import Clock

STEP = 0.02
rospy.init_node("partner")
clock = rospy.Publisher("/clock", Clock, queue_size=10)
while not rospy.has_param("/tick"):
    time.sleep(0.05)
now, ticks = 100.0, 0
while not rospy.has_param("/end"):
    ticks += 1
    if ticks % 5 == 0 and rospy.has_param("/back"):
        rospy.delete_param("/back")
        now = 50.0
    clock.publish(rospy.Time.from_sec(now))
    now += STEP
    time.sleep(STEP / 2)
