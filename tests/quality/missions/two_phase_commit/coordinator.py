"""Has two participants commit when both are prepared. What it decided is written down when all know it."""

import rospy
from std_msgs.msg import String

PLACES = ("north", "south")


def decide(decision: str) -> None:
    for place in PLACES:
        decisions[place].publish(decision)
    rospy.set_param("/decision", decision)


def on_prepared(message: String) -> None:
    prepared.add(message.data)
    if prepared == set(PLACES):
        decide("commit")


rospy.init_node("coordinator")
prepared = set()
decisions = {place: rospy.Publisher(f"{place}/decision", String, queue_size=10) for place in PLACES}
rospy.Subscriber("prepared", String, on_prepared)
if rospy.get_param("/begun", False):
    rospy.sleep(0.1)
    decide(rospy.get_param("/decision", "abort"))
rospy.set_param("/begun", True)
rospy.spin()
