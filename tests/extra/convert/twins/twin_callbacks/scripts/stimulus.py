#!/usr/bin/env python3
"""Numbers: some at once before the node first spins, then one now and then."""

import rospy
from std_msgs.msg import Int32

if __name__ == "__main__":
    rospy.init_node("stimulus")
    into = rospy.Publisher("in", Int32, queue_size=20)
    rospy.sleep(2)
    for number in range(3):
        into.publish(number)
    rospy.sleep(3.03)
    for number in range(10, 20):
        into.publish(number)
        rospy.sleep(0.25)
