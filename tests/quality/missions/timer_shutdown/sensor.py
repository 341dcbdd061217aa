"""Measures a hundred times a second."""

import rospy
from std_msgs.msg import Float32

rospy.init_node("sensor")
sample = rospy.Publisher("sample", Float32, queue_size=10)
rospy.sleep(0.1)
rate = rospy.Rate(100)
for number in range(6):
    sample.publish(number)
    rate.sleep()
