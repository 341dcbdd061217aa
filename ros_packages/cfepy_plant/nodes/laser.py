#!/usr/bin/env python3
"""A laser scanner that measures the distances to the walls of a map.

Subscribes: `ground_truth` (nav_msgs/Odometry), the real pose of the robot
Publishes, at ~rate: `scan` (sensor_msgs/LaserScan); a ray without a wall within ~range_max is inf, as in REP 117
            and once the static transform from ~base_frame to ~frame
Parameters: ~map, a YAML file as for map_server; ~rate 10 Hz; ~samples 180, ~angle_min -pi, ~angle_max pi (rad; a full
            circle has its last ray one step before the first); ~range_min 0.05 m, ~range_max 8 m;
            ~noise 0 m, standard deviation; ~seed 2; ~x, ~y, ~yaw 0, the place of the scanner on the robot;
            ~frame laser, ~base_frame base_link
"""

from __future__ import annotations

import contextlib
import math

import numpy as np
import rospy
import tf2_ros
from floor_map import read_map
from geometry_msgs.msg import TransformStamped
from nav_msgs.msg import Odometry
from sensor_msgs.msg import LaserScan

FULL_CIRCLE = 2 * math.pi


def param(name: str, default: float) -> float:
    """Return a private parameter that is a number."""
    return float(rospy.get_param("~" + name, default))


class Laser:
    """The node: the scanner at its place on the robot."""

    def __init__(self) -> None:
        self._walls = read_map(rospy.get_param("~map"))
        self._place = param("x", 0), param("y", 0), param("yaw", 0)
        self._noise = param("noise", 0)
        self._random = np.random.default_rng(int(rospy.get_param("~seed", 2)))
        self._frame = str(rospy.get_param("~frame", "laser"))
        self._scan = self._empty_scan()
        angles = [self._scan.angle_min + number * self._scan.angle_increment for number in range(self._samples)]
        self._cosines = np.array([math.cos(each) for each in angles])
        self._sines = np.array([math.sin(each) for each in angles])
        self._pose = None
        self._publisher = rospy.Publisher("scan", LaserScan, queue_size=10)
        self._broadcaster = tf2_ros.StaticTransformBroadcaster()
        self._broadcaster.sendTransform(self._transform())
        rospy.Subscriber("ground_truth", Odometry, self._on_pose, queue_size=1)

    def _empty_scan(self) -> LaserScan:
        self._samples = int(rospy.get_param("~samples", 180))
        scan = LaserScan(angle_min=param("angle_min", -math.pi), angle_max=param("angle_max", math.pi))
        is_full = abs(scan.angle_max - scan.angle_min - FULL_CIRCLE) < 1e-6
        scan.angle_increment = (scan.angle_max - scan.angle_min) / max(1, self._samples - (0 if is_full else 1))
        scan.angle_max = scan.angle_min + (self._samples - 1) * scan.angle_increment
        scan.range_min, scan.range_max = param("range_min", 0.05), param("range_max", 8.0)
        scan.header.frame_id = self._frame
        return scan

    def _transform(self) -> TransformStamped:
        transform = TransformStamped(child_frame_id=self._frame)
        transform.header.stamp = rospy.Time.now()
        transform.header.frame_id = str(rospy.get_param("~base_frame", "base_link"))
        transform.transform.translation.x, transform.transform.translation.y = self._place[:2]
        transform.transform.rotation.z = math.sin(self._place[2] / 2)
        transform.transform.rotation.w = math.cos(self._place[2] / 2)
        return transform

    def _on_pose(self, message: Odometry) -> None:
        turn = message.pose.pose.orientation
        self._pose = message.pose.pose.position.x, message.pose.pose.position.y, 2 * math.atan2(turn.z, turn.w)

    def run(self) -> None:
        """Scan until shutdown."""
        hertz = param("rate", 10)
        rate = rospy.Rate(hertz)
        self._scan.scan_time = 1 / hertz
        while not rospy.is_shutdown():
            rate.sleep()
            if self._pose is not None:
                self._scan.header.stamp = rospy.Time.now()
                self._scan.ranges = self._measured(*self._pose)
                self._publisher.publish(self._scan)

    def _measured(self, x: float, y: float, yaw: float) -> list[float]:
        cosine, sine = math.cos(yaw), math.sin(yaw)
        ahead, left, turn = self._place
        x, y = x + ahead * cosine - left * sine, y + ahead * sine + left * cosine
        cosine, sine = math.cos(yaw + turn), math.sin(yaw + turn)
        cosines = self._cosines * cosine - self._sines * sine
        sines = self._sines * cosine + self._cosines * sine
        ranges = self._walls.distances(x, y, cosines, sines)
        if self._noise:
            ranges = ranges + self._random.normal(0.0, self._noise, self._samples)
        ranges[ranges > self._scan.range_max] = np.inf
        return np.maximum(ranges, 0.0).tolist()


def main() -> None:
    rospy.init_node("laser")
    Laser().run()


if __name__ == "__main__":
    with contextlib.suppress(rospy.ROSInterruptException):
        main()
