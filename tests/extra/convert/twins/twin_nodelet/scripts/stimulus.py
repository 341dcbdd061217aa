#!/usr/bin/env python3
"""Numbers on two topics, and a pause."""

import random

import rospy
from std_msgs.msg import Int32, String
from std_srvs.srv import SetBool

if __name__ == "__main__":
    rospy.init_node("stimulus")
    out = rospy.Publisher("out", String, queue_size=100)
    numbers = rospy.Publisher("numbers", Int32, queue_size=10)
    more = rospy.Publisher("more", Int32, queue_size=10)
    pause = rospy.ServiceProxy("twin/pause", SetBool)
    rospy.sleep(1)
    rate = rospy.Rate(8)
    for cycle in range(80):
        numbers.publish(random.randrange(-1000, 1000))
        if cycle % 3 == 0:
            more.publish(cycle)
        if cycle in (20, 40):
            out.publish(pause(cycle == 20).message)
        rate.sleep()
    rospy.spin()
