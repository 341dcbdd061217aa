"""Gives a command every 10 ms."""

import rospy
from std_msgs.msg import Int32

rospy.init_node("pilot")
command = rospy.Publisher("command", Int32, queue_size=10)
rate = rospy.Rate(100)
for speed in range(20):
    command.publish(speed)
    rate.sleep()
