"""Fills one of two buffers while the other one is read, and then swaps them."""

import sys
import threading

import rospy
from std_msgs.msg import Int32


class Frame:
    def __init__(self) -> None:
        self.number = self.exposure = 0


class Driver:
    def __init__(self) -> None:
        self.frames = [Frame(), Frame()]
        self.front = 0
        self.ready = threading.Event()
        rospy.Subscriber("raw", Int32, self.on_raw)

    def on_raw(self, message: Int32) -> None:
        back = self.frames[1 - self.front]
        back.number = message.data
        back.exposure = message.data * 10
        self.front = 1 - self.front
        self.ready.set()

    def run(self) -> None:
        while not rospy.is_shutdown():
            self.ready.wait()
            self.ready.clear()
            frame = self.frames[self.front]
            number = frame.number
            rospy.loginfo("frame %d", number)
            if frame.exposure != number * 10:
                sys.exit(f"frame {number} has an exposure of {frame.exposure}")


rospy.init_node("camera_driver")
Driver().run()
