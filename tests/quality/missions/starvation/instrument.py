"""Asks for a value, and hands in new data when it has asked."""

import sys

import rospy
from std_msgs.msg import Int32

rospy.init_node("instrument")
seen = []
rospy.Subscriber("answer", Int32, lambda message: seen.append(message.data))
question = rospy.Publisher("question", Int32, queue_size=1)
data = rospy.Publisher("data", Int32, queue_size=1)
rospy.sleep(0.1)
question.publish(1)
data.publish(0)
rospy.sleep(0.01)
if seen != [10]:
    sys.exit(f"the answer is {seen}")
