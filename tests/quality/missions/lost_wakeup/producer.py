"""Gives the next sample when the last one is done."""

import sys

import rospy
from std_msgs.msg import Int32

rospy.init_node("producer")
done = []
rospy.Subscriber("done", Int32, done.append)
sample = rospy.Publisher("sample", Int32, queue_size=10)
rospy.sleep(0.1)
for number in range(4):
    sample.publish(number)
    if number % 2:
        rospy.sleep(0.01)
        if len(done) != number + 1:
            sys.exit(f"{number + 1} samples sent, {len(done)} done")
