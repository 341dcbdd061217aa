"""Starts a writer, and looks at what it writes before it has joined it."""

import sys
import threading

import rospy

lock = threading.Lock()
number = 0


def write() -> None:
    global number
    with lock:
        number = 1


rospy.init_node("cell")
writer = threading.Thread(target=write)
writer.start()
with lock:
    seen = number
writer.join()
if seen != 1:
    sys.exit(f"the number is {seen} still")
