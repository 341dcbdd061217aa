#!/usr/bin/env python3
"""Test node: takes ~count numbers from `numbers`, checks their order and ends."""

from __future__ import annotations

import rospy
from std_msgs.msg import UInt32


def main() -> None:
    rospy.init_node("count_sink")
    count = rospy.get_param("~count", 20)
    numbers: list[int] = []

    def on_number(message: UInt32) -> None:
        numbers.append(message.data)
        if len(numbers) == count:
            rospy.signal_shutdown("all numbers are here")

    subscriber = rospy.Subscriber("numbers", UInt32, on_number)
    rospy.spin()
    in_order = numbers == list(range(count))
    print(f"result: {len(numbers)} numbers from {subscriber.resolved_name}, sum {sum(numbers)}, in order {in_order}")


if __name__ == "__main__":
    main()
