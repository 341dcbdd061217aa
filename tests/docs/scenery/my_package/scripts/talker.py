#!/usr/bin/env python3
"""Says hello at a rate."""

import rospy
from std_msgs.msg import String

rospy.init_node("talker")
publisher = rospy.Publisher("chatter", String, queue_size=10)
rate = rospy.Rate(rospy.get_param("~rate", 5))
while not rospy.is_shutdown():
    publisher.publish("hello")
    rate.sleep()
