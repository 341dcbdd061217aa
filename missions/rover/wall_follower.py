#!/usr/bin/env python3
"""Drives a robot along the wall to its right.

Subscribes: `scan` (sensor_msgs/LaserScan), `safe_mode` (std_msgs/Bool; true stops the robot)
Publishes, at ~rate: `cmd_vel` (geometry_msgs/Twist)
Parameters: ~rate 10 Hz; ~distance 0.5 m to the wall; ~speed 0.3 m/s; ~oldest_scan 0.3 s, after which the robot stops
"""

from __future__ import annotations

import contextlib
import math

import rospy
from geometry_msgs.msg import Twist
from sensor_msgs.msg import LaserScan
from std_msgs.msg import Bool

AHEAD = -math.radians(30), math.radians(30)
RIGHT = -math.radians(100), -math.radians(60)
STEER, DAMP, MOST_TURN = 2.0, 1.0, 1.0  # rad/s for each m, s, rad/s


class WallFollower:
    """The node: the last scan, and the command that follows from it."""

    def __init__(self) -> None:
        self._distance = float(rospy.get_param("~distance", 0.5))
        self._speed = float(rospy.get_param("~speed", 0.3))
        self._oldest = rospy.Duration.from_sec(float(rospy.get_param("~oldest_scan", 0.3)))
        self._scan = None
        self._is_safe = False
        self._before = 0.0
        self._publisher = rospy.Publisher("cmd_vel", Twist, queue_size=1)
        rospy.Subscriber("scan", LaserScan, self._on_scan, queue_size=1)
        rospy.Subscriber("safe_mode", Bool, self._on_safe_mode, queue_size=1)

    def _on_scan(self, message: LaserScan) -> None:
        self._scan = message

    def _on_safe_mode(self, message: Bool) -> None:
        self._is_safe = message.data

    def run(self) -> None:
        """Drive until shutdown."""
        rate = rospy.Rate(float(rospy.get_param("~rate", 10)))
        while not rospy.is_shutdown():
            rate.sleep()
            self._publisher.publish(self._command())

    def _command(self) -> Twist:
        scan, command = self._scan, Twist()
        if scan is None or self._is_safe:
            return command
        if rospy.Time.now() - scan.header.stamp > self._oldest:
            rospy.logwarn_throttle(1.0, "the last scan is too old: the robot stops")
            return command
        if nearest(scan, *AHEAD) < 1.3 * self._distance:
            command.angular.z = MOST_TURN
            self._before = 0.0
            return command
        error = nearest(scan, *RIGHT) - self._distance
        change, self._before = error - self._before, error
        command.linear.x = self._speed
        command.angular.z = min(MOST_TURN, max(-MOST_TURN, -STEER * error - DAMP * change))
        return command


def nearest(scan: LaserScan, first: float, last: float) -> float:
    """Return the smallest range between two angles."""
    begin = max(0, math.ceil((first - scan.angle_min) / scan.angle_increment))
    end = math.floor((last - scan.angle_min) / scan.angle_increment) + 1
    return min(scan.ranges[begin:end])


def main() -> None:
    rospy.init_node("wall_follower")
    WallFollower().run()


if __name__ == "__main__":
    with contextlib.suppress(rospy.ROSInterruptException):
        main()
