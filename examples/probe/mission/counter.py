#!/usr/bin/env python3
"""Counter node: adds up what it is told.

Subscribes: `add` (std_msgs/Float64)
Publishes:  `count` (probe_msgs/Count), after each message
Services:   `reset` (std_srvs/Trigger)
Parameters: ~limit  of the total; what would exceed it is not added
"""

from __future__ import annotations

import threading

import rospy
from probe_msgs.msg import Count
from std_msgs.msg import Float64
from std_srvs.srv import Trigger, TriggerRequest, TriggerResponse


class Counter:
    """The total, which callbacks of two topics and a service share."""

    def __init__(self) -> None:
        self.lock = threading.Lock()
        self.number = 0
        self.total = 0.0
        self.publisher = rospy.Publisher("count", Count, queue_size=10)
        rospy.Subscriber("add", Float64, self.add)
        rospy.Service("reset", Trigger, self.reset)

    def add(self, message: Float64) -> None:
        with self.lock:
            if not self.total + message.data <= rospy.get_param("~limit"):
                rospy.logwarn("%g would be too much", message.data)
                return
            self.number += 1
            self.total += message.data
            count = Count(number=self.number, total=self.total)
        self.publisher.publish(count)

    def reset(self, request: TriggerRequest) -> TriggerResponse:
        with self.lock:
            self.number, self.total = 0, 0.0
        return TriggerResponse(success=True, message="counting anew")


def main() -> None:
    rospy.init_node("counter")
    Counter()
    print("counting")
    rospy.spin()


if __name__ == "__main__":
    main()
