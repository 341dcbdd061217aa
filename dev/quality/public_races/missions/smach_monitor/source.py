"""Publishes one message, which later subscribers get, too."""

import rospy
from std_msgs.msg import Empty

rospy.init_node("source")
rospy.Publisher("/go", Empty, queue_size=1, latch=True).publish()
rospy.spin()
