"""A client of rosbridge that offers a service. Each request must have an id of its own."""

import sys
import threading

import rospy
from rosbridge_library.capabilities.advertise_service import AdvertiseService
from rosbridge_library.protocol import Protocol

rospy.init_node("bridge")
ids = []
asked = threading.Event()


class Client(Protocol):
    def send(self, message, cid=None):
        ids.append(message["id"])
        if len(ids) == 2:
            asked.set()


protocol = Client("client")
AdvertiseService(protocol).advertise_service({"op": "advertise_service", "service": "/add", "type": "std_srvs/Trigger"})
asked.wait()
if len(set(ids)) != 2:
    sys.exit(f"two requests have one id: {ids}")
sys.exit(0)
