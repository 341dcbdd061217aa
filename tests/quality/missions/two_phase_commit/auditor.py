"""Begins the transaction."""

import rospy
from std_msgs.msg import Empty

rospy.init_node("auditor")
prepare = rospy.Publisher("prepare", Empty, queue_size=1)
rospy.sleep(0.1)
prepare.publish()
