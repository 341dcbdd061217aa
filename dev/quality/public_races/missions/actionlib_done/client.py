"""Sends one goal after another. The callback of a goal's end must have run when the wait for its result ends."""

import sys

import actionlib
import rospy
from actionlib_tutorials.msg import FibonacciAction, FibonacciGoal
from std_msgs.msg import Int32

GOALS = 3
rospy.init_node("client")
answers = rospy.Publisher("answers", Int32, queue_size=10)
done = []


def end(status, result):
    answers.publish(result.sequence[0])
    done.append(result.sequence[0])


client = actionlib.SimpleActionClient("fibonacci", FibonacciAction)
client.wait_for_server()
for number in range(GOALS):
    client.send_goal(FibonacciGoal(order=number), done_cb=end)
    if not client.wait_for_result(rospy.Duration(2)):
        break
    if done != list(range(number + 1)):
        sys.exit(f"the wait for goal {number} ended before its callback")
