"""Answers at once."""

import rospy
from std_msgs.msg import Int32

rospy.init_node("server")
reply = rospy.Publisher("reply", Int32, queue_size=10)
rospy.Subscriber("request", Int32, lambda message: reply.publish(message.data))
rospy.spin()
