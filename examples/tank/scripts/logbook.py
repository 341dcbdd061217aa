#!/usr/bin/env python3
"""A node in Python beside those in C++: writes down when the pump was switched."""

import rospy
from std_msgs.msg import Bool, Float64

level = 0.0


def level_came(message):
    """Remember the level."""
    global level
    level = message.data


def switched(message):
    """Write it down."""
    rospy.loginfo("pump %s at %.2f m", "on" if message.data else "off", level)


rospy.init_node("logbook")
rospy.Subscriber("level", Float64, level_came)
rospy.Subscriber("pump", Bool, switched)
rospy.spin()
