"""Opens a parachute a little after the first sign of landing; two sensors give signs."""

import rospy
from std_msgs.msg import Empty


class Parachute:
    def __init__(self) -> None:
        self.armed = False
        self.charge = rospy.Publisher("charge", Empty, queue_size=10)
        rospy.Subscriber("altitude_low", Empty, self.on_sign)
        rospy.Subscriber("shock", Empty, self.on_sign)

    def on_sign(self, _message: Empty) -> None:
        if not self.armed:
            rospy.loginfo("landing")
            self.armed = True
            rospy.Timer(rospy.Duration(0.01), self.fire, oneshot=True)

    def fire(self, _event: object) -> None:
        self.charge.publish()


rospy.init_node("parachute")
Parachute()
rospy.spin()
