"""Sends series of messages to two echo nodes by turns, and prints their round-trip times.

Arguments: names of the two, how many series of each, messages per series. It prints a line for each: its name and the
median in us.
"""

import statistics
import sys
import threading
import time

import rospy
from sensor_msgs.msg import JointState

PERIOD_S = 0.005
LIMIT_S = 30.0

names, series, messages = sys.argv[1:3], int(sys.argv[3]), int(sys.argv[4])
rospy.init_node("measures")
came = threading.Event()
took = {name: [] for name in names}
asks = {name: rospy.Publisher("/ask_" + name, JointState, queue_size=100, tcp_nodelay=True) for name in names}
for name in names:
    rospy.Subscriber("/answer_" + name, JointState, lambda message: came.set(), queue_size=100, tcp_nodelay=True)


def ask(name):
    """Send one message and wait for its echo. Returns the seconds, or None without an echo."""
    came.clear()
    begun = time.perf_counter()
    asks[name].publish(JointState(name=[f"joint{number}" for number in range(7)], position=[0.1] * 7))
    return time.perf_counter() - begun if came.wait(1.0) else None


for name in names:
    begun = time.time()
    while ask(name) is None:  # they have not found each other yet
        if time.time() - begun > LIMIT_S:
            sys.exit("nobody answers at /ask_" + name)
    time.sleep(0.5)
for _ in range(series):
    for name in names:
        for _ in range(messages):
            seconds = ask(name)
            if seconds is None:
                sys.exit("a message to " + name + " was lost")
            took[name].append(seconds)
            time.sleep(PERIOD_S)
for name in names:
    print(name, "%.1f" % (statistics.median(took[name]) * 1e6), flush=True)
