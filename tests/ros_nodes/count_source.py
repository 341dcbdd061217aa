#!/usr/bin/env python3
"""Test node: waits for a subscriber of `numbers`, sends 0 to ~count - 1 and ends."""

from __future__ import annotations

import rospy
from std_msgs.msg import UInt32


def main() -> None:
    rospy.init_node("count_source")
    publisher = rospy.Publisher("numbers", UInt32, queue_size=100)
    rate = rospy.Rate(100)
    while publisher.get_num_connections() == 0 and not rospy.is_shutdown():
        rate.sleep()
    count = rospy.get_param("~count", 20)
    for number in range(count):
        publisher.publish(number)
        rate.sleep()
    print(f"result: {count} numbers sent on {publisher.resolved_name}")


if __name__ == "__main__":
    main()
