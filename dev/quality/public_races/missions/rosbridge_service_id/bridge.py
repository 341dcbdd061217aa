"""A client of rosbridge that offers a service. Each request must have an id of its own."""

import sys

import rospy
from rosbridge_library.capabilities.advertise_service import AdvertiseService
from rosbridge_library.protocol import Protocol

rospy.init_node("bridge")
ids = []


class Client(Protocol):
    def send(self, message, cid=None):
        ids.append(message["id"])


protocol = Client("client")
AdvertiseService(protocol).advertise_service({"op": "advertise_service", "service": "/add", "type": "std_srvs/Trigger"})
while len(ids) < 2:
    rospy.sleep(0.01)
if len(set(ids)) != 2:
    sys.exit(f"two requests have one id: {ids}")
sys.exit(0)
