#!/usr/bin/env python3
"""The twin of src/twin.cpp: lists that keep the last messages, as long as roscpp's queues."""

import threading
from collections import deque

import rospy
from std_msgs.msg import Int32, String


class Queue:
    """Messages that wait, the oldest of which makes room."""

    def __init__(self, name, length):
        self.name, self.waiting = name, deque(maxlen=length)

    def call(self, most=100):
        for _ in range(min(most, len(self.waiting))):
            out.publish(f"{self.name} {self.waiting.popleft()}")


class Twin:
    """The node."""

    def __init__(self):
        self.queues = [Queue("small", 1), Queue("medium", 4), Queue("own", 3)]
        self.at_once = False
        self.end = None
        rospy.Subscriber("in", Int32, self.take, queue_size=20)

    def take(self, message):
        for queue in self.queues:
            queue.waiting.append(message.data)
        if self.at_once:
            self.spin_once()
        if self.end:
            self.at_once = False
            self.end.set()

    def spin_once(self):
        """Call the waiting entries of the global queue: in the order of the first messages, one callback each."""
        small, medium, _ = self.queues
        spread = max(len(medium.waiting), len(small.waiting))
        for number in range(spread):
            if number == 0:
                small.call()
            medium.call(1)

    def run(self):
        own = self.queues[2]
        rospy.sleep(3.5)
        out.publish("once")
        self.spin_once()
        out.publish("own queue")
        own.call(1)
        out.publish("one")
        own.call()
        rospy.sleep(1)
        out.publish("both")
        own.call()
        self.spin_once()
        out.publish("asynchronous")
        self.at_once = True
        rospy.sleep(2.2)
        self.end = threading.Event()  # roscpp's spinner ends with the callbacks of the next message
        self.end.wait()
        out.publish("stopped")
        rospy.sleep(0.55)
        out.publish("not empty" if own.waiting else "empty")
        own.waiting.clear()
        out.publish("cleared")
        self.spin_once()
        self.end = None
        self.at_once = True
        rospy.spin()


if __name__ == "__main__":
    rospy.init_node("twin")
    out = rospy.Publisher("out", String, queue_size=100)
    Twin().run()
