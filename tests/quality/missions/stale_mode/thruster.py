"""Fires as commanded, in the mode that was set before: two topics, so two threads."""

import rospy
from std_msgs.msg import Float32, String

mode = ["safe"]


def on_mode(message: String) -> None:
    mode[0] = message.data


def on_fire(message: Float32) -> None:
    fired.publish(f"{mode[0]} {message.data:g}")


rospy.init_node("thruster")
fired = rospy.Publisher("fired", String, queue_size=10)
rospy.Subscriber("mode", String, on_mode)
rospy.Subscriber("fire", Float32, on_fire)
rospy.spin()
