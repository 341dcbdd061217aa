"""Tells the goal once, when it is up."""

import rospy
from std_msgs.msg import Float32

rospy.init_node("commander")
goal = rospy.Publisher("goal", Float32, queue_size=1)
goal.publish(4.2)
rospy.spin()
