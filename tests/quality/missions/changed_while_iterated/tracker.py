"""Reports all robots that it knows of; new ones come in by a callback."""

import threading

import rospy
from std_msgs.msg import Empty, String


class Tracker:
    def __init__(self) -> None:
        self.robots = {"base": 0}
        self.due = threading.Event()
        self.status = rospy.Publisher("status", String, queue_size=10)
        rospy.Subscriber("report", Empty, lambda message: self.due.set())
        rospy.Subscriber("robot", String, self.on_robot)

    def on_robot(self, message: String) -> None:
        self.robots[message.data] = self.robots.get(message.data, 0) + 1

    def run(self) -> None:
        while not rospy.is_shutdown():
            self.due.wait()
            self.due.clear()
            for name, count in self.robots.items():
                self.status.publish(f"{name} {count}")


rospy.init_node("tracker")
Tracker().run()
