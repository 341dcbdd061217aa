"""Writes down what it gets. At the end a hook closes the file, whoever may be writing."""

import io
import threading

import rospy
from std_msgs.msg import Empty, Int32


class Logger:
    def __init__(self) -> None:
        self.file = io.StringIO()
        self.lock = threading.Lock()
        rospy.on_shutdown(self.close)
        rospy.Subscriber("value", Int32, self.on_value)
        rospy.Subscriber("stop", Empty, lambda message: rospy.signal_shutdown("asked to"))

    def on_value(self, message: Int32) -> None:
        if not rospy.is_shutdown():
            self.file.write(f"{rospy.get_time()} {message.data}\n")

    def close(self) -> None:
        self.file.close()


rospy.init_node("logger")
Logger()
rospy.spin()
