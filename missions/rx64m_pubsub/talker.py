#!/usr/bin/env python3
"""Talker node: counts on a topic, so that a listener can tell when a message is missing.

Publishes:  `counter` (std_msgs/UInt32 at ~rate): 0, 1, 2, ... and round to 0 after 2**32 - 1
Parameters: ~rate 100 Hz
"""

from __future__ import annotations

import contextlib

import rospy
from std_msgs.msg import UInt32


def main() -> None:
    rospy.init_node("talker")
    publisher = rospy.Publisher("counter", UInt32, queue_size=10)
    rate = rospy.Rate(float(rospy.get_param("~rate", 100.0)))
    message = UInt32(data=0)
    rospy.on_shutdown(lambda: rospy.loginfo("talker: %d messages sent", message.data))
    while not rospy.is_shutdown():
        publisher.publish(message)
        message.data = (message.data + 1) & 0xFFFFFFFF
        rate.sleep()


if __name__ == "__main__":
    with contextlib.suppress(rospy.ROSInterruptException):
        main()
