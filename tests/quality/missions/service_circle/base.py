"""Moves with its own lock held, and asks the arm whether it is in the way; the arm does the same."""

import threading

import rospy
from std_msgs.msg import Empty
from std_srvs.srv import Trigger, TriggerRequest, TriggerResponse

lock = threading.Lock()


def on_move(_message: Empty) -> None:
    with lock:
        rospy.ServiceProxy("arm_free", Trigger)()


def on_asked(_request: TriggerRequest) -> TriggerResponse:
    with lock:
        return TriggerResponse(True, "")


rospy.init_node("base")
rospy.Service("base_free", Trigger, on_asked)
rospy.Subscriber("move", Empty, on_move)
rospy.spin()
