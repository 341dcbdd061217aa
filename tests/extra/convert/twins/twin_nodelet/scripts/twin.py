#!/usr/bin/env python3
"""The twin of src/twin.cpp: a node, as rospy has no nodelets."""

import rospy
from std_msgs.msg import Float64, Int32, String
from std_srvs.srv import SetBool, SetBoolResponse


class Twin:
    """The node."""

    def __init__(self):
        self.gain = rospy.get_param("~gain", 1.0)
        self.last = 0
        self.paused = False
        self.out = rospy.Publisher("out", String, queue_size=100)
        self.ticks = rospy.Publisher("~ticks", Float64, queue_size=10)
        rospy.Subscriber("in", Int32, self.heard, queue_size=10)
        rospy.Subscriber("more", Int32, lambda message: self.out.publish(f"more {message.data}"), queue_size=10)
        rospy.Service("~pause", SetBool, self.pause)
        rospy.Timer(rospy.Duration(0.35), self.tick)
        rospy.loginfo("%s with gain %.1f", rospy.get_name(), self.gain)

    def heard(self, message):
        self.last = message.data
        self.out.publish(f"{rospy.get_name()} heard {message.data}")

    def tick(self, _event):
        if not self.paused:
            self.ticks.publish(self.gain * self.last)

    def pause(self, request):
        self.paused = request.data
        return SetBoolResponse(True, "paused" if self.paused else "goes on")


if __name__ == "__main__":
    rospy.init_node("twin")
    Twin()
    rospy.spin()
