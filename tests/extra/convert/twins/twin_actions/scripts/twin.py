#!/usr/bin/env python3
"""The twin of src/twin.cpp."""

import actionlib
import rospy
from actionlib.msg import TestAction, TestFeedback, TestGoal, TestResult
from actionlib_msgs.msg import GoalStatus
from std_msgs.msg import String


class Counter:
    """The server."""

    def __init__(self, name):
        self.server = actionlib.SimpleActionServer(name, TestAction, self.execute, False)
        self.server.start()

    def execute(self, goal):
        out.publish(f"goal {goal.goal}")
        rate = rospy.Rate(10)
        for number in range(1, goal.goal + 1):
            if self.server.is_preempt_requested():
                self.server.set_preempted(TestResult(-number), "preempted")
                return
            self.server.publish_feedback(TestFeedback(number))
            rate.sleep()
        end = self.server.set_aborted if goal.goal == 3 else self.server.set_succeeded
        end(TestResult(goal.goal * 2), "three" if goal.goal == 3 else "counted")


def done(state, result):
    out.publish(f"done {GoalStatus.to_string(state)} {result.result}")


if __name__ == "__main__":
    rospy.init_node("twin")
    out = rospy.Publisher("out", String, queue_size=100)
    counter = Counter("count")
    client = actionlib.SimpleActionClient("other", TestAction)
    client.wait_for_server()
    rospy.sleep(rospy.Time(rospy.Time.now().secs + 2) - rospy.Time.now())
    client.send_goal(
        TestGoal(4), done, lambda: out.publish("active"), lambda message: out.publish(f"feedback {message.feedback}")
    )
    in_time = client.wait_for_result(rospy.Duration(3))
    out.publish(f"{'in time' if in_time else 'late'} {GoalStatus.to_string(client.get_state())}")
    rospy.spin()
