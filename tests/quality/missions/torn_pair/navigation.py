"""Uses a position only while the quality that an application reports beside it is good."""

import sys
import threading

import rospy
from std_msgs.msg import UInt8MultiArray


class Navigation:
    def __init__(self) -> None:
        self.good = True
        self.wild = threading.Event()
        rospy.Subscriber("quality", UInt8MultiArray, self.on_quality)
        rospy.Subscriber("position", UInt8MultiArray, self.on_position)

    def on_quality(self, packet: UInt8MultiArray) -> None:
        self.good = bool(packet.data[16])

    def on_position(self, packet: UInt8MultiArray) -> None:
        if self.good and packet.data[16] > 100:
            self.wild.set()


rospy.init_node("navigation")
if Navigation().wild.wait(0.5):
    sys.exit("a wild position was believed")
