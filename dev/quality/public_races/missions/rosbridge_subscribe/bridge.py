"""A client of rosbridge that leaves while its subscription to a further topic is handled."""

import threading

import rospy
from rosbridge_library.capabilities.subscribe import Subscribe
from rosbridge_library.protocol import Protocol

rospy.init_node("bridge")
subscribe = Subscribe(Protocol("client"))


def add(topic):
    subscribe.subscribe({"op": "subscribe", "topic": topic, "type": "std_msgs/Int32"})


for each in ("/first", "/second"):
    add(each)
leave = threading.Thread(target=subscribe.finish)
leave.start()
add("/third")
leave.join()
