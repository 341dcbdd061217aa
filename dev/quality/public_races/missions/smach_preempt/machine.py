"""A concurrence that is preempted while its states end. If it has serviced the preemption, its outcome must tell so."""

import sys
import threading

import rospy
import smach

rospy.init_node("machine")


class Wait(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["done", "preempted"])

    def execute(self, userdata):
        rospy.sleep(0.1)
        if self.preempt_requested():
            self.service_preempt()
            return "preempted"
        return "done"


both = smach.Concurrence(
    outcomes=["done", "preempted"],
    default_outcome="preempted",
    outcome_map={"done": {"LEFT": "done", "RIGHT": "done"}},
)
with both:
    smach.Concurrence.add("LEFT", Wait())
    smach.Concurrence.add("RIGHT", Wait())
asked = threading.Event()


def preempt():
    rospy.sleep(0.1)
    asked.set()
    both.request_preempt()


threading.Thread(target=preempt).start()
outcome = both.execute()
if asked.is_set() and not both.preempt_requested() and outcome == "done":
    rospy.sleep(0.1)
    if not both.preempt_requested():
        sys.exit("the concurrence has serviced the preemption, and its outcome is done")
