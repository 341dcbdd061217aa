"""Is prepared when it is asked, and does what the coordinator decides first."""

import sys

import rospy
from std_msgs.msg import Empty, String


def on_decision(message: String) -> None:
    global outcome
    if not outcome:
        outcome = message.data
        told.publish(outcome)


place, outcome = sys.argv[1], ""
rospy.init_node("participant", anonymous=True)
prepared = rospy.Publisher("prepared", String, queue_size=10)
told = rospy.Publisher("outcome", String, queue_size=10)
rospy.Subscriber("prepare", Empty, lambda message: prepared.publish(place))
rospy.Subscriber(f"{place}/decision", String, on_decision)
rospy.spin()
