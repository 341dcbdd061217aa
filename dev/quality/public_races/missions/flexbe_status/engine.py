"""Publishes the status of FlexBE's engine, which later subscribers get, too."""

import rospy
from flexbe_msgs.msg import BEStatus

rospy.init_node("engine")
rospy.Publisher("flexbe/status", BEStatus, queue_size=1, latch=True).publish(BEStatus(code=BEStatus.READY))
rospy.spin()
