"""Comes down, and counts the charges that go off."""

import sys

import rospy
from std_msgs.msg import Empty

rospy.init_node("capsule")
charges = []
rospy.Subscriber("charge", Empty, charges.append)
signs = [rospy.Publisher(topic, Empty, queue_size=1) for topic in ("altitude_low", "shock")]
rospy.sleep(0.1)
for sign in signs:
    sign.publish()
rospy.sleep(0.1)
if len(charges) != 1:
    sys.exit(f"{len(charges)} charges went off")
