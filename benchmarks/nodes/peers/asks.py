#!/usr/bin/env python3
"""Sends a JointState of seven joints, and the next one after the answer. Prints a line after a number of answers."""

import rospy
from sensor_msgs.msg import JointState

FIRST = 500  # answers before the measurement

answered = 0
count = int(rospy.myargv()[1])
rospy.init_node("asks")
publisher = rospy.Publisher("question", JointState, queue_size=1)
question = JointState(name=[f"joint_{number}" for number in range(7)])
question.position = question.velocity = question.effort = [0.1 * number for number in range(7)]


def on_answer(message):
    global answered
    answered += 1
    if answered == FIRST:
        print("begin", flush=True)
    if answered == FIRST + count:
        print("end", flush=True)
    publisher.publish(question)


subscriber = rospy.Subscriber("answer", JointState, on_answer, tcp_nodelay=True)
while not (publisher.get_num_connections() and subscriber.get_num_connections()):
    rospy.sleep(0.05)
rospy.sleep(0.1)
publisher.publish(question)
rospy.spin()
