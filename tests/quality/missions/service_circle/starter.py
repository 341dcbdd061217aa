"""Has both move."""

import rospy
from std_msgs.msg import Empty

rospy.init_node("starter")
move = rospy.Publisher("move", Empty, queue_size=1)
rospy.wait_for_service("arm_free")
rospy.wait_for_service("base_free")
rospy.sleep(0.1)
move.publish()
