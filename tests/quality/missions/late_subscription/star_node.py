"""A star tracker: a ROS node that answers an application's question for the attitude."""

import rospy
from std_msgs.msg import UInt8MultiArray


def on_request(packet: UInt8MultiArray) -> None:
    reply.publish(data=b"\x08\x92" + packet.data[2:16] + b"\x2a")


rospy.init_node("star_tracker")
reply = rospy.Publisher("attitude_reply", UInt8MultiArray, queue_size=10)
rospy.Subscriber("attitude_request", UInt8MultiArray, on_request)
rospy.spin()
