#!/usr/bin/env python3
"""The twin of src/twin.cpp."""

import rospy
from rospy_tutorials.srv import AddTwoInts, AddTwoIntsResponse
from std_msgs.msg import String
from std_srvs.srv import Empty, EmptyResponse, SetBool, SetBoolResponse, Trigger, TriggerResponse


def sleep_until(time):
    rospy.sleep(time - rospy.Time.now())


class Twin:
    """The node."""

    def __init__(self):
        self.out = rospy.Publisher("out", String, queue_size=100)
        self.calls = 0

    def say(self, what):
        self.out.publish(what)

    def add(self, request):
        self.say(f"add {request.a + request.b}")
        return AddTwoIntsResponse(request.a + request.b)

    def set(self, request):
        self.calls += 1
        self.say(f"set call {self.calls}")
        return None if self.calls == 2 else SetBoolResponse(request.data, f"call {self.calls}")

    def trigger(self, _request):
        self.say("trigger")
        return TriggerResponse(message="of an event")

    def empty(self, _request):
        self.say("empty")
        return EmptyResponse()

    def call(self, what, name, kind, *args):
        try:
            self.say(f"{what} {rospy.ServiceProxy(name, kind)(*args).sum}")
        except rospy.ServiceException:
            self.say(f"{what} failed")

    def run(self):
        add = rospy.Service("add", AddTwoInts, self.add)
        rospy.Service("set", SetBool, self.set)
        rospy.Service("trigger", Trigger, self.trigger)
        rospy.Service("~empty", Empty, self.empty)
        self.say("none not there")
        begun = rospy.Time.now()
        try:
            rospy.wait_for_service("nowhere", 0.5)
        except rospy.ROSException:
            sleep_until(begun + rospy.Duration(1))
            self.say("wait not there")
        rospy.wait_for_service("times")
        sleep_until(begun + rospy.Duration(2.5))
        for number in range(3):
            self.call("times", "times", AddTwoInts, number + 6, 7)
        self.call("times", "times", AddTwoInts, -1, 7)
        self.call("persistent", "times", AddTwoInts, 3, 5)
        self.call("bare call", "times", AddTwoInts, -1, 7)
        self.call("bare", "times", AddTwoInts, 9, 7)
        try:
            rospy.ServiceProxy("nowhere", Trigger)()
        except rospy.ServiceException:
            self.say("nobody there")
        rospy.sleep(5)
        add.shutdown()
        rospy.spin()


if __name__ == "__main__":
    rospy.init_node("twin")
    twin = Twin()
    rospy.sleep(1)
    twin.run()
