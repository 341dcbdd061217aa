"""Every member tells its number; who has heard of none that is smaller leads."""

import sys

import rospy
from std_msgs.msg import Empty, Int32

MEMBERS = 3


def on_start(_message: Empty) -> None:
    claim.publish(me)
    rospy.sleep(0.05)
    if min(heard) == me:
        leader.publish(me)


me = int(sys.argv[1])
rospy.init_node("member", anonymous=True)
heard = {me}
claim = rospy.Publisher("claim", Int32, queue_size=10)
leader = rospy.Publisher("leader", Int32, queue_size=10)
rospy.Subscriber("claim", Int32, lambda message: heard.add(message.data))
rospy.Subscriber("start", Empty, on_start)
rospy.spin()
