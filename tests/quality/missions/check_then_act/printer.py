"""Prints what is in its queue; whoever cancels empties the queue."""

import collections
import threading

import rospy
from std_msgs.msg import Empty, String


class Printer:
    def __init__(self) -> None:
        self.jobs = collections.deque()
        self.work = threading.Event()
        self.printed = rospy.Publisher("printed", String, queue_size=10)
        rospy.Subscriber("job", String, self.on_job)
        rospy.Subscriber("cancel", Empty, self.on_cancel)

    def on_job(self, message: String) -> None:
        self.jobs.append(message.data)
        self.work.set()

    def on_cancel(self, _message: Empty) -> None:
        self.jobs.clear()

    def run(self) -> None:
        while not rospy.is_shutdown():
            self.work.wait()
            self.work.clear()
            while self.jobs:
                rospy.loginfo("%d jobs", len(self.jobs))
                self.printed.publish(self.jobs.popleft())


rospy.init_node("printer")
Printer().run()
