"""Stamps images with the help of a service, and passes them on."""

import rospy
from std_msgs.msg import Int32
from std_srvs.srv import Trigger


def on_image(message: Int32) -> None:
    stamp()
    stamped.publish(message.data)


rospy.init_node("relay")
rospy.wait_for_service("stamp")
stamp = rospy.ServiceProxy("stamp", Trigger)
stamped = rospy.Publisher("stamped", Int32, queue_size=10)
rospy.Subscriber("image", Int32, on_image, queue_size=10)
rospy.spin()
