"""Sends requests on a topic; a callback looks up who waits for the reply."""

import sys
import threading

import rospy
from std_msgs.msg import Int32


class Client:
    def __init__(self) -> None:
        self.pending = {}
        self.request = rospy.Publisher("request", Int32, queue_size=10)
        rospy.Subscriber("reply", Int32, self.on_reply)

    def on_reply(self, message: Int32) -> None:
        waiting = self.pending.pop(message.data, None)
        if waiting is not None:
            waiting.set()

    def ask(self, number: int) -> bool:
        answered = threading.Event()
        self.request.publish(number)
        self.pending[number] = answered
        return answered.wait(0.1)


rospy.init_node("client")
client = Client()
rospy.sleep(0.1)
for number in range(3):
    if not client.ask(number):
        sys.exit(f"request {number} was never answered")
