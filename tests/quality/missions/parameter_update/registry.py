"""Has numbers taken, and looks whether one is taken twice."""

import sys

import rospy
from std_msgs.msg import Empty, Int32

rospy.init_node("registry")
numbers = []
rospy.Subscriber("taken", Int32, lambda message: numbers.append(message.data))
go = rospy.Publisher("go", Empty, queue_size=10)
rospy.sleep(0.1)
for _ in range(2):
    go.publish()
    rospy.sleep(0.01)
if len(set(numbers)) < len(numbers):
    sys.exit(f"a number was given out twice: {sorted(numbers)}")
