"""Publishes two messages at once."""

import rospy
from std_msgs.msg import Int32

rospy.init_node("source")
numbers = rospy.Publisher("numbers", Int32, queue_size=10)
rospy.sleep(0.2)
for number in range(2):
    numbers.publish(number)
rospy.spin()
