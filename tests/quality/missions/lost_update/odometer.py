"""Adds up the ticks of two wheels. Its callbacks run in two threads, and both change the sum."""

import rospy
from std_msgs.msg import Int32


class Odometer:
    def __init__(self) -> None:
        self.travelled = 0
        self.distance = rospy.Publisher("distance", Int32, queue_size=10)
        rospy.Subscriber("left_ticks", Int32, self.on_ticks)
        rospy.Subscriber("right_ticks", Int32, self.on_ticks)

    def on_ticks(self, message: Int32) -> None:
        travelled = self.travelled + message.data
        self.distance.publish(travelled)
        self.travelled = travelled


rospy.init_node("odometer")
Odometer()
rospy.spin()
