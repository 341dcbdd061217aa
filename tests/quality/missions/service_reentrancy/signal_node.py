"""Gives the signal."""

import rospy
from std_msgs.msg import Empty

rospy.init_node("signal")
go = rospy.Publisher("go", Empty, queue_size=1)
rospy.sleep(0.2)
go.publish()
