"""Drives past some walls."""

import rospy
from std_msgs.msg import Float32

rospy.init_node("rover")
scan = rospy.Publisher("scan", Float32, queue_size=10)
odom = rospy.Publisher("odom", Float32, queue_size=10)
rospy.sleep(0.1)
for _ in range(2):
    scan.publish(3.0)
    odom.publish(0.5)
    rospy.sleep(0.01)
