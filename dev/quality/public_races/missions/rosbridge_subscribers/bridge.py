"""Two clients of rosbridge, each in its thread: one leaves a topic while the other one joins it."""

import os
import threading

import rospy
from rosbridge_library.internal.subscribers import manager

rospy.init_node("bridge")
seen = []


def leave():
    manager.unsubscribe("first", "/numbers")


def join():
    manager.subscribe("second", "/numbers", seen.append, "std_msgs/Int32")


manager.subscribe("first", "/numbers", lambda message: None, "std_msgs/Int32")
rospy.sleep(0.1)
clients = [threading.Thread(target=each) for each in (leave, join)]
for each in clients:
    each.start()
for each in clients:
    each.join()
rospy.sleep(0.3)
if not seen:
    rospy.logerr("the second client has joined the topic and gets no message")
    os._exit(1)
