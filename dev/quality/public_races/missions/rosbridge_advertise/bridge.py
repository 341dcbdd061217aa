"""A client of rosbridge that ends its advertisement of a topic and advertises it again, handled by two threads."""

import sys
import threading

import rospy
from rosbridge_library.capabilities.advertise import Advertise
from rosbridge_library.internal.publishers import manager
from rosbridge_library.protocol import Protocol

rospy.init_node("bridge")
manager.unregister_timeout = 0.1
advertise = Advertise(Protocol("client"))
errors = []


def again():
    try:
        advertise.advertise({"op": "advertise", "id": "two", "topic": "/numbers", "type": "std_msgs/Int32"})
    except KeyError as error:
        errors.append(error)


advertise.advertise({"op": "advertise", "id": "one", "topic": "/numbers", "type": "std_msgs/Int32"})
thread = threading.Thread(target=again)
thread.start()
advertise.unadvertise({"op": "unadvertise", "id": "one", "topic": "/numbers"})
thread.join()
if errors or "/numbers" not in advertise._registrations:
    sys.exit(f"the topic is advertised, and has no registration {errors}")
