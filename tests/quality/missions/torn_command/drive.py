"""A callback takes commands, a timer sends the latest one to the wheels. Both wheels should turn alike."""

import threading

import rospy
from std_msgs.msg import Int32


class Drive:
    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.left = self.right = 0
        rospy.Subscriber("command", Int32, self.on_command)
        rospy.Timer(rospy.Duration(0.01), self.on_timer)

    def on_command(self, message: Int32) -> None:
        self.left = message.data
        self.right = message.data

    def on_timer(self, _event: object) -> None:
        if self.left != self.right:
            raise ValueError("the wheels turn at different speeds")


rospy.init_node("drive")
Drive()
rospy.spin()
