#!/usr/bin/env python3
"""The twin of src/twin.cpp: the output of its callbacks, in the order of its subscriptions."""

import rospy
from std_msgs.msg import Int32, String


class Twin:
    """All forms of callbacks at once."""

    def __init__(self):
        self.out = rospy.Publisher("out", String, queue_size=100)
        self.heard = {"listener": 0, "shared": 0}
        self.sum = 0
        self.shared = True
        self.waiting = []
        rospy.Subscriber("in", Int32, lambda message: self.waiting.append(message), queue_size=10)

    def say(self, form, value):
        self.out.publish(f"{form} {value}")

    def method(self, which, value):
        self.heard[which] += 1
        self.say(f"method {self.heard[which]}", value)

    def forms(self, value):
        """Yield functions that print the output of each form, in the order of the subscriptions."""
        yield lambda: self.say("function, ConstPtr", value)
        yield lambda: self.say("function, ConstPtr by value", value)
        yield lambda: self.say("function, const&", value)
        yield lambda: self.say("function, by value", value)
        yield lambda: self.say("function, Ptr", value + 1000)
        yield lambda: self.say("function, MessageEvent", value)
        yield lambda: self.say("function, MessageEvent of a message that may change", value + 2000)
        yield lambda: self.say("bind, more", value + 100)
        yield lambda: self.method("listener", value)
        yield lambda: self.say("const method", value)
        yield lambda: self.say("method, MessageEvent", value)
        yield lambda: self.say("bound method b", value)
        if self.shared:
            yield lambda: self.method("shared", value)
        yield lambda: self.say("function, ConstPtr", value)
        yield lambda: self.say("function, const&", value)
        yield lambda: self.add(value)
        if self.shared:
            yield lambda: self.say("function, ConstPtr", value)

    def add(self, value):
        self.sum += value
        self.say("lambda", self.sum)

    def run(self):
        rospy.sleep(4.5)
        rate = rospy.Rate(10)
        cycle = 0
        while not rospy.is_shutdown():
            waiting, self.waiting = self.waiting[-10:], []
            for message in waiting:
                for act in self.forms(message.data):
                    act()
            if cycle == 15:
                self.shared = False
            cycle += 1
            rate.sleep()


if __name__ == "__main__":
    rospy.init_node("twin")
    Twin().run()
