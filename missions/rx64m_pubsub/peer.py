#!/usr/bin/env python3
"""Peer node: counts on one topic, and follows the count of another node on a second one.

Two of them, each remapped to hear what the other says, show what a board carries in both directions at once.

Publishes:  `sent` (std_msgs/UInt32 at ~rate): 0, 1, 2, ... and round to 0 after 2**32 - 1
Subscribes: `heard` (std_msgs/UInt32)
Parameters: ~rate 100 Hz, ~report_period 5 s
"""

from __future__ import annotations

import contextlib

import rospy
from std_msgs.msg import UInt32


class SequenceCheck:
    """Counts messages received, lost (skipped numbers) and out of order (a number seen before, or a peer anew)."""

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


class Peer:
    """Publishes its count at a rate, and reports the counts that it received from the other node."""

    def __init__(self) -> None:
        self._heard = SequenceCheck()
        self._count = UInt32(data=0)
        self._publisher = rospy.Publisher("sent", UInt32, queue_size=10)
        rospy.Subscriber("heard", UInt32, self._heard.on_message, queue_size=100)
        rospy.Timer(rospy.Duration(float(rospy.get_param("~report_period", 5.0))), self._report)
        rospy.on_shutdown(self._report)

    def run(self) -> None:
        """Count until shutdown."""
        rate = rospy.Rate(float(rospy.get_param("~rate", 100.0)))
        while not rospy.is_shutdown():
            self._publisher.publish(self._count)
            self._count.data = (self._count.data + 1) & 0xFFFFFFFF
            rate.sleep()

    def _report(self, _event: object = None) -> None:
        heard = self._heard
        told = (self._count.data, heard.received, heard.lost, heard.backwards)
        rospy.loginfo("%d sent, %d received, %d lost, %d out of order", *told)


def main() -> None:
    rospy.init_node("peer")
    Peer().run()


if __name__ == "__main__":
    with contextlib.suppress(rospy.ROSInterruptException):
        main()
