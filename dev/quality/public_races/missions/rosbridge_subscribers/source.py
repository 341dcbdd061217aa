"""Publishes a number every 10 ms."""

import rospy
from std_msgs.msg import Int32

rospy.init_node("source")
numbers = rospy.Publisher("numbers", Int32, queue_size=10)
count = 0
while not rospy.is_shutdown():
    numbers.publish(count)
    count += 1
    rospy.sleep(0.01)
