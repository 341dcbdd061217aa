"""A concurrence of two states. At the end of each, its callback must know the outcomes of both."""

import os

import rospy
import smach

rospy.init_node("machine")


class Wait(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["done"])

    def execute(self, userdata):
        rospy.sleep(0.1)
        return "done"


def end_of_state(outcomes):
    if set(outcomes) != {"LEFT", "RIGHT"}:
        rospy.logerr("the end of a state is told with the outcomes %s", outcomes)
        os._exit(1)
    return False


both = smach.Concurrence(
    outcomes=["done"],
    default_outcome="done",
    outcome_map={"done": {"LEFT": "done"}},
    child_termination_cb=end_of_state,
)
with both:
    smach.Concurrence.add("LEFT", Wait())
    smach.Concurrence.add("RIGHT", Wait())
both.execute()
rospy.sleep(0.1)
