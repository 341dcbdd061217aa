#!/usr/bin/env python3
"""A server for the node's client, and a client that sends goals and takes one back."""

import actionlib
import rospy
from actionlib.msg import TestAction, TestFeedback, TestGoal, TestResult
from std_msgs.msg import String


def execute(goal):
    for number in range(goal.goal):
        server.publish_feedback(TestFeedback(10 * number))
        rospy.sleep(0.1)
    server.set_succeeded(TestResult(goal.goal + 100))


if __name__ == "__main__":
    rospy.init_node("stimulus")
    out = rospy.Publisher("out", String, queue_size=100)
    server = actionlib.SimpleActionServer("other", TestAction, execute, False)
    server.start()
    client = actionlib.SimpleActionClient("count", TestAction)
    client.wait_for_server()
    rospy.sleep(5)
    for number in (2, 3, 30):
        client.send_goal(TestGoal(number))
        if number == 30:
            rospy.sleep(0.55)
            client.cancel_goal()
        client.wait_for_result(rospy.Duration(5))
        out.publish(f"state {client.get_state()} {client.get_goal_status_text()} {client.get_result().result}")
    rospy.spin()
