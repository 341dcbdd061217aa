"""Takes samples as they come, with an event for "there is something"."""

import threading

import rospy
from std_msgs.msg import Int32


class Consumer:
    def __init__(self) -> None:
        self.samples = []
        self.something = threading.Event()
        self.done = rospy.Publisher("done", Int32, queue_size=10)
        rospy.Subscriber("sample", Int32, self.on_sample)

    def on_sample(self, message: Int32) -> None:
        self.samples.append(message.data)
        self.something.set()

    def next(self) -> int:
        while not self.samples:
            self.something.clear()
            self.something.wait()
        return self.samples.pop(0)

    def run(self) -> None:
        while not rospy.is_shutdown():
            self.done.publish(self.next())


rospy.init_node("consumer")
Consumer().run()
