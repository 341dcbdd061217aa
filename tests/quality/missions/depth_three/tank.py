"""Vents and fills a tank. Both look at what the other one does, and each forgets one moment of it."""

import sys
import threading

import rospy
from std_msgs.msg import Empty, String


class Tank:
    def __init__(self) -> None:
        self.venting = self.filling = self.pressed = False
        self.vent = threading.Event()
        self.log = rospy.Publisher("log", String, queue_size=10)
        rospy.Subscriber("log", String, lambda message: None)
        rospy.Subscriber("vent", Empty, lambda message: self.vent.set())
        rospy.Subscriber("fill", Empty, self.on_fill)

    def on_fill(self, _message: Empty) -> None:
        if self.venting:
            self.filling = True
            self.log.publish("filling")
            self.pressed = True
            self.log.publish("full")
            self.filling = self.pressed = False

    def run(self) -> None:
        while not rospy.is_shutdown():
            self.vent.wait()
            self.vent.clear()
            self.venting = True
            self.log.publish("valve opens")
            self.venting = False
            if self.filling:
                self.log.publish("valve closes")
                if self.filling and self.pressed:
                    sys.exit("the valve closed under pressure")


rospy.init_node("tank")
Tank().run()
