#!/usr/bin/env python3
"""Health node of the arm: its own housekeeping, one small number to a topic.

Motors have no thermometer: the node estimates the temperature of each winding from its current (ohmic heat against
conduction into the arm's structure) and warns when one gets too hot. Every value goes out as a scalar message, whose
bytes never move: four bytes, little-endian, right at the start of the message. That is what lets a housekeeping
collector that knows nothing of ROS copy them by offset (see README.md).

Subscribes: `joint_states_throttle` (sensor_msgs/JointState, some 10 Hz; effort is the motor current, A)
Publishes, at ~rate: `arm_health/samples` (std_msgs/UInt32, joint states seen since the start)
            `arm_health/peak_current` (std_msgs/Float32, A) and `arm_health/peak_speed` (std_msgs/Float32, rad/s), both
            the largest magnitude of any joint since the last report
            `arm_health/hottest_motor` (std_msgs/Float32, estimated winding temperature, degrees Celsius)
Parameters: ~rate 1 Hz, ~structure_temperature 20 C, ~winding_resistance 2.4 ohm, ~heat_capacity 45 J/K,
            ~thermal_resistance 3.5 K/W, ~warning_temperature 110 C
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence

import rospy
from arm_description import JOINT_NAMES, JOINTS
from sensor_msgs.msg import JointState
from std_msgs.msg import Float32, UInt32


class WindingTemperatures:
    """First-order thermal model of every motor, fed with current samples."""

    def __init__(self) -> None:
        self._structure = float(rospy.get_param("~structure_temperature", 20.0))
        resistance = float(rospy.get_param("~winding_resistance", 2.4))
        thermal_resistance = float(rospy.get_param("~thermal_resistance", 3.5))
        self._time_constant = float(rospy.get_param("~heat_capacity", 45.0)) * thermal_resistance
        self._rise_per_square_ampere = resistance * thermal_resistance
        self.celsius = [self._structure] * JOINTS

    def add(self, currents: Sequence[float], seconds: float) -> None:
        """Heat the windings with these currents (A) for that long."""
        share = -math.expm1(-seconds / self._time_constant)
        self.celsius = [
            t + share * (self._structure + self._rise_per_square_ampere * i * i - t)
            for t, i in zip(self.celsius, currents)
        ]


class ArmHealth:
    """The node: collects samples, and reports once per period."""

    def __init__(self) -> None:
        self._warning = float(rospy.get_param("~warning_temperature", 110.0))
        self._temperatures = WindingTemperatures()
        self._samples = 0
        self._peak_current = 0.0
        self._peak_speed = 0.0
        self._last_stamp: float | None = None
        self._samples_out = rospy.Publisher("arm_health/samples", UInt32, queue_size=1)
        self._current_out = rospy.Publisher("arm_health/peak_current", Float32, queue_size=1)
        self._speed_out = rospy.Publisher("arm_health/peak_speed", Float32, queue_size=1)
        self._motor_out = rospy.Publisher("arm_health/hottest_motor", Float32, queue_size=1)
        rospy.Subscriber("joint_states_throttle", JointState, self._on_state, queue_size=10)

    def _on_state(self, message: JointState) -> None:
        stamp = message.header.stamp.to_sec()
        if self._last_stamp is not None and stamp > self._last_stamp:
            self._temperatures.add(message.effort, stamp - self._last_stamp)
        self._last_stamp = stamp
        self._samples += 1
        self._peak_current = max(self._peak_current, max(map(abs, message.effort)))
        self._peak_speed = max(self._peak_speed, max(map(abs, message.velocity)))

    def _report(self) -> None:
        hottest = max(self._temperatures.celsius)
        self._samples_out.publish(self._samples & 0xFFFFFFFF)
        self._current_out.publish(self._peak_current)
        self._speed_out.publish(self._peak_speed)
        self._motor_out.publish(hottest)
        self._peak_current = self._peak_speed = 0.0
        if hottest > self._warning:
            joint = JOINT_NAMES[self._temperatures.celsius.index(hottest)]
            rospy.logwarn_throttle(10.0, f"motor of {joint} is at {hottest:.0f} C")

    def run(self) -> None:
        """Report until shutdown."""
        rate = rospy.Rate(float(rospy.get_param("~rate", 1.0)))
        while not rospy.is_shutdown():
            rate.sleep()
            self._report()


def main() -> None:
    rospy.init_node("arm_health")
    ArmHealth().run()


if __name__ == "__main__":
    with contextlib.suppress(rospy.ROSInterruptException):
        main()
