#!/usr/bin/env python3
"""Test node: wait_for_message on a silent topic, on a latched one and on one that a thread feeds."""

from __future__ import annotations

import threading

import rospy
from geometry_msgs.msg import Point
from std_msgs.msg import String


def main() -> None:
    rospy.init_node("waiting")
    try:
        rospy.wait_for_message("silence", String, timeout=0.2)
        silent = "a message"
    except rospy.ROSException as error:
        silent = f"{type(error).__name__}: {error}"

    latched = rospy.Publisher("greeting", String, queue_size=1, latch=True)
    latched.publish("hello")
    greeting = rospy.wait_for_message("greeting", String, timeout=5.0)

    points = rospy.Publisher("points", Point, queue_size=1)
    done = threading.Event()

    def feed() -> None:
        while not done.is_set():
            points.publish(1.0, 2.0, 3.0)
            rospy.sleep(0.05)

    feeder = threading.Thread(target=feed)
    feeder.start()
    point = rospy.wait_for_message("points", Point, timeout=5.0)
    done.set()
    feeder.join()
    print(f"result: silence gives {silent!r}, latched {greeting.data!r}, point {(point.x, point.y, point.z)}")


if __name__ == "__main__":
    main()
