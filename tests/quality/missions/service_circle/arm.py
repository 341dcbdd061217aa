"""Moves with its own lock held, and asks the base whether it is in the way; the base does the same."""

import threading

import rospy
from std_msgs.msg import Empty
from std_srvs.srv import Trigger, TriggerRequest, TriggerResponse

lock = threading.Lock()


def on_move(_message: Empty) -> None:
    with lock:
        rospy.ServiceProxy("base_free", Trigger)()


def on_asked(_request: TriggerRequest) -> TriggerResponse:
    with lock:
        return TriggerResponse(True, "")


rospy.init_node("arm")
rospy.Service("arm_free", Trigger, on_asked)
rospy.Subscriber("move", Empty, on_move)
rospy.spin()
