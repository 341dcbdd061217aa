"""Sends joint states at 1 kHz and counts those of another one: a node for both worlds.

Arguments: its own name, the other's, how many messages. After both hear each other, each sends messages with the
numbers 1, 2, 3 ... in `effort`, then end marks with 0, until it is shut down. At the other's first end mark, it prints
the messages received before.

A connection alone is not enough to begin: rospy connects a subscriber before it has its callback, and drops the
messages that arrive between. So a node greets with -1 as soon as it is connected and its callback is there, and sends
numbers only after it has heard the other's greeting.

`queue_size` is 1,000, so that rospy's own queues lose nothing and any loss is the bridge's. rospy reads up to 64 KiB at
once, which are 239 of these messages, and drops those beyond the queue's size. With 100, a node that has not read for
0.1 s loses messages from any sender.
"""

import sys
import threading
import time

import rospy
from sensor_msgs.msg import JointState

QUEUE = 1000
GREETING = -1
JOINTS = [f"joint{number}" for number in range(7)]

name, other, messages = rospy.myargv(sys.argv)[1:4]
messages = int(messages)
rospy.init_node(name)
numbers = []
told = []
greeted = threading.Event()


def hear(message):
    number = int(message.effort[0])
    if number == GREETING:
        greeted.set()
    elif number:
        numbers.append(number)
    elif not told:
        told.append(True)
        missing = sorted(set(range(1, messages + 1)) - set(numbers))
        order = "in order" if numbers == list(range(1, messages + 1)) else f"without {missing[:20]}"
        print(name, "heard", len(numbers), order, flush=True)


stream = rospy.Publisher("/of_" + name, JointState, queue_size=QUEUE, tcp_nodelay=True)
heard = rospy.Subscriber("/of_" + other, JointState, hear, queue_size=QUEUE, tcp_nodelay=True)


def send(number):
    """All of a message has the same size, whatever its number."""
    state = JointState(name=JOINTS, position=[0.1] * 7, velocity=[0.2] * 7, effort=[float(number)] * 7)
    state.header.stamp = rospy.get_rostime()
    stream.publish(state)


rate = rospy.Rate(100)
while not (stream.get_num_connections() and heard.get_num_connections()):
    rate.sleep()
while not greeted.is_set():
    send(GREETING)
    rate.sleep()
send(GREETING)  # the other one waits for it, and hears it
rate = rospy.Rate(1000)
begun = time.time()
for number in range(1, messages + 1):
    send(number)
    rate.sleep()
print(name, "sent", messages, f"in {time.time() - begun:.1f} s", flush=True)
rate = rospy.Rate(10)
while not rospy.is_shutdown():
    send(0)
    rate.sleep()
