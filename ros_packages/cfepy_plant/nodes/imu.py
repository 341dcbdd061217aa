#!/usr/bin/env python3
"""An inertial sensor: the turn rate and the accelerations of the robot, and the direction that follows from them.

Subscribes: `ground_truth` (nav_msgs/Odometry)
Publishes, at ~rate: `imu` (sensor_msgs/Imu) in ~frame; the orientation is the integral of the measured turn rate, so it
            drifts with ~gyro_bias
Parameters: ~rate 50 Hz; ~gyro_noise and ~gyro_bias 0 rad/s, ~accel_noise 0 m/s^2 (noise: standard deviations);
            ~seed 3; ~frame imu
"""

from __future__ import annotations

import contextlib
import math
import random

import rospy
from nav_msgs.msg import Odometry
from sensor_msgs.msg import Imu

GRAVITY = 9.80665  # m/s^2
PERFECT = 1e-6  # variance of a sensor without noise; 0 stands for unknown


def param(name: str, default: float) -> float:
    """Return a private parameter that is a number."""
    return float(rospy.get_param("~" + name, default))


class ImuNode:
    """The node: the motion of the robot as the sensor feels it."""

    def __init__(self) -> None:
        self._gyro_noise, self._gyro_bias = param("gyro_noise", 0), param("gyro_bias", 0)
        self._accel_noise = param("accel_noise", 0)
        self._random = random.Random(int(rospy.get_param("~seed", 3)))
        self._frame = str(rospy.get_param("~frame", "imu"))
        self._yaw = None
        self._last = self._truth = None
        self._publisher = rospy.Publisher("imu", Imu, queue_size=10)
        rospy.Subscriber("ground_truth", Odometry, self._on_truth, queue_size=1)

    def _on_truth(self, message: Odometry) -> None:
        self._truth = message

    def run(self) -> None:
        """Measure until shutdown."""
        rate = rospy.Rate(param("rate", 50))
        while not rospy.is_shutdown():
            rate.sleep()
            truth = self._truth
            if truth is not None:
                self._publisher.publish(self._measured(truth))
                self._last = truth

    def _measured(self, truth: Odometry) -> Imu:
        before = truth if self._last is None else self._last
        seconds = (truth.header.stamp - before.header.stamp).to_sec()
        speed, turn = truth.twist.twist.linear.x, truth.twist.twist.angular.z
        ahead = (speed - before.twist.twist.linear.x) / seconds if seconds > 0 else 0.0
        message = Imu()
        message.header.stamp, message.header.frame_id = truth.header.stamp, self._frame
        message.angular_velocity.z = self._noisy(turn, self._gyro_noise) + self._gyro_bias
        message.linear_acceleration.x = self._noisy(ahead, self._accel_noise)
        message.linear_acceleration.y = self._noisy(speed * turn, self._accel_noise)
        message.linear_acceleration.z = self._noisy(GRAVITY, self._accel_noise)
        if self._yaw is None:
            start = truth.pose.pose.orientation
            self._yaw = 2 * math.atan2(start.z, start.w)
        self._yaw += message.angular_velocity.z * seconds
        message.orientation.z, message.orientation.w = math.sin(self._yaw / 2), math.cos(self._yaw / 2)
        gyro, accel = max(PERFECT, self._gyro_noise**2), max(PERFECT, self._accel_noise**2)
        message.orientation_covariance = message.angular_velocity_covariance = _diagonal(gyro)
        message.linear_acceleration_covariance = _diagonal(accel)
        return message

    def _noisy(self, value: float, deviation: float) -> float:
        return value + self._random.gauss(0, deviation) if deviation else value


def _diagonal(value: float) -> list[float]:
    return [value, 0.0, 0.0, 0.0, value, 0.0, 0.0, 0.0, value]


def main() -> None:
    rospy.init_node("imu")
    ImuNode().run()


if __name__ == "__main__":
    with contextlib.suppress(rospy.ROSInterruptException):
        main()
