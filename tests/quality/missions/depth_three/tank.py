"""Vents and fills a tank. Both look at what the other one does, and each forgets one moment of it."""

import rospy
from std_msgs.msg import Empty, String


class Tank:
    def __init__(self) -> None:
        self.venting = self.filling = self.pressed = False
        self.log = rospy.Publisher("log", String, queue_size=10)
        rospy.Subscriber("vent", Empty, self.on_vent)
        rospy.Subscriber("fill", Empty, self.on_fill)

    def on_fill(self, _message: Empty) -> None:
        if self.venting:
            self.filling = True
            self.log.publish("filling")
            self.pressed = True

    def on_vent(self, _message: Empty) -> None:
        self.filling = self.pressed = False
        self.venting = True
        self.log.publish("valve opens")
        self.venting = False
        if self.filling and not self.pressed:
            self.log.publish("valve closes")
            if self.pressed:
                raise RuntimeError("the valve closed under pressure")


rospy.init_node("tank")
Tank()
rospy.spin()
