"""A concurrence of two states, each of which asks an arm to move. It must end when both have ended."""

import os
import threading

import rospy
import smach
from std_srvs.srv import Empty

rospy.init_node("machine")
rospy.wait_for_service("/move")


class Move(smach.State):
    def __init__(self):
        smach.State.__init__(self, outcomes=["done"])

    def execute(self, userdata):
        rospy.ServiceProxy("/move", Empty)()
        return "done"


both = smach.Concurrence(outcomes=["done"], default_outcome="done", outcome_map={"done": {"LEFT": "done"}})
with both:
    smach.Concurrence.add("LEFT", Move())
    smach.Concurrence.add("RIGHT", Move())
ended = threading.Event()


def watch():
    if not ended.wait(1):
        rospy.logerr("the concurrence does not end")
        os._exit(1)


threading.Thread(target=watch, daemon=True).start()
both.execute()
ended.set()
