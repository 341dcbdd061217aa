"""Delivers frames in bursts."""

import rospy
from std_msgs.msg import Int32

rospy.init_node("sensor")
raw = rospy.Publisher("raw", Int32, queue_size=10)
rospy.sleep(0.1)
for number in range(6):
    raw.publish(number)
    if number % 3 == 2:
        rospy.sleep(0.01)
