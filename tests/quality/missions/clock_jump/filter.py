"""Filters at 10 Hz; the gain follows from the time since the last step."""

import math

import rospy
from std_msgs.msg import Empty, Float32


class Filter:
    def __init__(self) -> None:
        self.last = None
        self.gain = rospy.Publisher("gain", Float32, queue_size=10)
        rospy.Subscriber("restart", Empty, self.on_restart)

    def on_restart(self, _message: Empty) -> None:
        self.last = None

    def step(self) -> None:
        now = rospy.get_time()
        if self.last is not None:
            self.gain.publish(math.sqrt(now - self.last))
        self.last = now

    def run(self) -> None:
        rate = rospy.Rate(10, reset=True)
        while not rospy.is_shutdown():
            self.step()
            rate.sleep()


rospy.init_node("filter")
try:
    Filter().run()
except rospy.ROSInterruptException:
    pass
