"""A client of rosbridge with a queue. The loop that sends to the client also puts the messages into the queue."""

import os
import threading

import rospy
from rosbridge_library.internal.subscription_modifiers import MessageHandler

rospy.init_node("bridge")
free = threading.Event()
ended = threading.Event()


def publish(message):
    free.wait()  # until the loop can send to the client


def watch():
    if not ended.wait(1):
        rospy.logerr("the loop cannot put a message into the queue")
        os._exit(1)


threading.Thread(target=watch, daemon=True).start()
handler = MessageHandler(None, publish).set_queue_length(5)
for number in range(3):
    handler.handle_message(number)
free.set()
ended.set()
