#!/usr/bin/env python3
"""Messages and calls for the node, and calls that it makes."""

import rospy
from geometry_msgs.msg import Twist
from std_msgs.msg import String
from std_srvs.srv import SetBool, SetBoolResponse

if __name__ == "__main__":
    rospy.init_node("helper")
    rospy.Service(
        "helper", SetBool, lambda request: SetBoolResponse(True, "some text in an answer, longer than others")
    )
    twists = rospy.Publisher("twists", Twist, queue_size=5)
    texts = rospy.Publisher("texts", String, queue_size=5)
    for name in ("twists_out", "texts_out", "latched", "result"):
        rospy.Subscriber(name, rospy.AnyMsg, lambda _message: None)
    rospy.Subscriber("result", String, lambda message: print("RESULT", message.data))
    rospy.wait_for_service("set")
    proxy = rospy.ServiceProxy("set", SetBool)
    rate = rospy.Rate(10)
    while not rospy.is_shutdown():
        twists.publish(Twist())
        texts.publish("a text that is always equally long, and longer than what a string has room for in itself")
        proxy(True)
        rate.sleep()
