"""Gives the signal."""

import rospy
from std_msgs.msg import Empty

rospy.init_node("signal")
go = rospy.Publisher("go", Empty, queue_size=1)
rospy.sleep(0.5)  # hands look for their service every 0.3 s
go.publish()
