"""A concurrence that ends when its first state does. The other state is preempted, and asks an arm to move first."""

import os
import threading

import rospy
import smach
from std_srvs.srv import Empty

rospy.init_node("machine")
rospy.wait_for_service("/move")


class Quick(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["done"])

    def execute(self, userdata):
        rospy.sleep(0.1)
        return "done"


class Slow(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["done"])
        self.stop = threading.Event()

    def execute(self, userdata):
        self.stop.wait()
        rospy.ServiceProxy("/move", Empty)()
        return "done"

    def request_preempt(self):
        smach.State.request_preempt(self)
        self.stop.set()


both = smach.Concurrence(
    outcomes=["done"],
    default_outcome="done",
    outcome_map={"done": {"QUICK": "done"}},
    child_termination_cb=lambda outcomes: True,
)
with both:
    smach.Concurrence.add("QUICK", Quick())
    smach.Concurrence.add("SLOW", Slow())
ended = threading.Event()


def watch():
    if not ended.wait(1):
        rospy.logerr("the concurrence does not end")
        os._exit(1)


threading.Thread(target=watch, daemon=True).start()
both.execute()
ended.set()
