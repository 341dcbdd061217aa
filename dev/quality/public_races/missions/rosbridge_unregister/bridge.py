"""A client of rosbridge with a queue leaves. The loop that ends its subscription also sends to the client."""

import os
import threading

import rospy
from rosbridge_library.capabilities.subscribe import Subscription

rospy.init_node("bridge")
free = threading.Event()
ended = threading.Event()


def send(message, fragment_size=None, compression="none"):
    free.wait()  # until the loop can send to the client


def watch():
    if not ended.wait(1.5):
        rospy.logerr("the loop cannot end the subscription")
        os._exit(1)


threading.Thread(target=watch, daemon=True).start()
subscription = Subscription("client", "/numbers", send)
subscription.subscribe(msg_type="std_msgs/Int32", queue_length=5)
now = rospy.Time.now()
rospy.sleep(rospy.Time(now.secs + 1) - now)
subscription.unregister()
free.set()
ended.set()
rospy.spin()
