#!/usr/bin/env python3
"""Offers a service that multiplies and refuses negative numbers, and calls the node's services; prints the results."""

import rospy
from rospy_tutorials.srv import AddTwoInts, AddTwoIntsResponse
from std_msgs.msg import String
from std_srvs.srv import Empty, SetBool, Trigger


def times(request):
    if request.a < 0:
        raise ValueError("negative")
    return AddTwoIntsResponse(request.a * request.b)


def tell(name, kind, *args):
    """Call a service and print its result."""
    try:
        answer = repr(str(rospy.ServiceProxy(name, kind)(*args)))
    except rospy.ServiceException as error:
        answer = type(error).__name__
    out.publish(f"{name}: {answer}")


if __name__ == "__main__":
    rospy.init_node("stimulus")
    out = rospy.Publisher("out", String, queue_size=100)
    rospy.sleep(2.5)
    rospy.Service("times", AddTwoInts, times)
    rospy.sleep(1.5)
    for number in range(4):
        tell("add", AddTwoInts, number, 2**40)
        tell("set", SetBool, bool(number % 2))
    tell("trigger", Trigger)
    tell("twin/empty", Empty)
    rospy.sleep(5)
    tell("add", AddTwoInts, 1, 2)
    tell("set", SetBool, True)
