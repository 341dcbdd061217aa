"""Sends its name and the peer that it received last, 50 times a second: a node for both worlds.

Arguments: its node's name, the other node's name, and a name for this start of it. It prints each peer that has
reported receiving messages of this very start.
"""

import sys

import rospy
from std_msgs.msg import String

name, other, me = rospy.myargv(sys.argv)[1:4]
rospy.init_node(name)
met = []
heard = ["nobody"]


def hear(message):
    who, whom = message.data.split()
    heard[0] = who
    if whom == me and who not in met[-1:]:
        met.append(who)
        print(me, "met", who, flush=True)


tell = rospy.Publisher("/of_" + name, String, queue_size=10)
rospy.Subscriber("/of_" + other, String, hear, queue_size=10)
rate = rospy.Rate(50)
while not rospy.is_shutdown():
    tell.publish(f"{me} {heard[0]}")
    rate.sleep()
