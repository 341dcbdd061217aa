"""Sends a value, and has the logger stop."""

import rospy
from std_msgs.msg import Empty, Int32

rospy.init_node("source")
value = rospy.Publisher("value", Int32, queue_size=10)
stop = rospy.Publisher("stop", Empty, queue_size=10)
rospy.sleep(0.1)
value.publish(1)
stop.publish()
