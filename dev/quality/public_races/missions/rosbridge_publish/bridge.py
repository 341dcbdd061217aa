"""A client of rosbridge that leaves while its message on a further topic is handled."""

import threading

import rospy
from rosbridge_library.capabilities.publish import Publish
from rosbridge_library.internal.publishers import manager
from rosbridge_library.protocol import Protocol
from std_msgs.msg import Int32

rospy.init_node("bridge")
manager.unregister_timeout = 0.1
topics = ["/first", "/second", "/third"]
publishers = [rospy.Publisher(topic, Int32, queue_size=10) for topic in topics]
publish = Publish(Protocol("client"))


def send(topic):
    publish.publish({"op": "publish", "topic": topic, "msg": {"data": 1}})


for each in topics[:2]:
    send(each)
leave = threading.Thread(target=publish.finish)
leave.start()
send(topics[2])
leave.join()
