"""Answers from a table. New data take long to come in, and only then is the old table thrown away."""

import rospy
from std_msgs.msg import Int32

table = {1: 10}


def on_data(_message: Int32) -> None:
    for line in range(20):
        rospy.logdebug("line %d", line)
    table.clear()


def on_question(message: Int32) -> None:
    answer.publish(table.get(message.data, -1))


rospy.init_node("calibration")
answer = rospy.Publisher("answer", Int32, queue_size=10)
rospy.Subscriber("question", Int32, on_question)
rospy.Subscriber("data", Int32, on_data)
rospy.spin()
