#!/usr/bin/env python3
"""Listener node: follows the talker's count and reports what arrived and what did not.

Subscribes: `counter` (std_msgs/UInt32)
Parameters: ~report_period 5 s
"""

from __future__ import annotations

import rospy
from std_msgs.msg import UInt32


class SequenceCheck:
    """Counts messages received, lost (skipped numbers) and out of order (a number seen before, or a new talker)."""

    def __init__(self) -> None:
        self.received = 0
        self.lost = 0
        self.backwards = 0
        self._expected: int | None = None

    def on_message(self, message: UInt32) -> None:
        self.received += 1
        if self._expected is not None and message.data != self._expected:
            gap = (message.data - self._expected) & 0xFFFFFFFF
            if gap < 0x80000000:
                self.lost += gap
            else:
                self.backwards += 1
        self._expected = (message.data + 1) & 0xFFFFFFFF

    def report(self, _event: object = None) -> None:
        rospy.loginfo("listener: %d received, %d lost, %d out of order", self.received, self.lost, self.backwards)


def main() -> None:
    rospy.init_node("listener")
    check = SequenceCheck()
    rospy.Subscriber("counter", UInt32, check.on_message, queue_size=100)
    rospy.Timer(rospy.Duration(float(rospy.get_param("~report_period", 5.0))), check.report)
    rospy.on_shutdown(check.report)
    rospy.spin()


if __name__ == "__main__":
    main()
