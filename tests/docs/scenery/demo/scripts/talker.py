#!/usr/bin/env python3
"""Counts at a rate, from the start again when it is asked to."""

import rospy
from std_msgs.msg import String
from std_srvs.srv import Trigger, TriggerResponse


def reset(_request):
    global count
    count = 0
    return TriggerResponse(success=True)


rospy.init_node("talker")
count = 0
publisher = rospy.Publisher("chatter", String, queue_size=10)
rospy.Service("~reset", Trigger, reset)
rate = rospy.Rate(rospy.get_param("~rate", 5))
while not rospy.is_shutdown():
    publisher.publish(f"hello {count}")
    count += 1
    rate.sleep()
