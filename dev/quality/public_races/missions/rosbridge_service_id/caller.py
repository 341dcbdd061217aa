"""Calls the service from two threads at once."""

import threading

import rospy
from std_srvs.srv import Trigger

rospy.init_node("caller")
rospy.wait_for_service("/add")


def call():
    try:
        rospy.ServiceProxy("/add", Trigger)()
    except rospy.ServiceException:
        pass


for _ in range(2):
    threading.Thread(target=call, daemon=True).start()
rospy.spin()
