"""Has a leader elected."""

import rospy
from std_msgs.msg import Empty

rospy.init_node("starter")
start = rospy.Publisher("start", Empty, queue_size=1)
rospy.sleep(0.1)
start.publish()
