#!/usr/bin/env python3
"""The battery of a robot: the motors and the electronics drain it.

Subscribes: `motor_power` (std_msgs/Float32, W)
Publishes, at ~rate: `battery_state` (sensor_msgs/BatteryState), and `battery_percent` (std_msgs/Float32), whose bytes
            never move, so that cFE applications can read them
Parameters: ~rate 2 Hz; ~capacity 20 Wh; ~charge 1, the part that is there at the beginning; ~idle_power 4 W of the
            electronics; ~voltage_full 12.6 V, ~voltage_empty 10.5 V; ~resistance 0.1 ohm
"""

from __future__ import annotations

import contextlib

import rospy
from battery_model import BatteryModel
from sensor_msgs.msg import BatteryState
from std_msgs.msg import Float32


def param(name: str, default: float) -> float:
    """Return a private parameter that is a number."""
    return float(rospy.get_param("~" + name, default))


class Battery:
    """The node: the power that the robot uses, and the energy that is left."""

    def __init__(self) -> None:
        self._model = BatteryModel(
            param("capacity", 20),
            param("charge", 1),
            param("voltage_full", 12.6),
            param("voltage_empty", 10.5),
            param("resistance", 0.1),
        )
        self._idle = param("idle_power", 4)
        self._powers: list[float] = []
        self._power = 0.0
        self._state = rospy.Publisher("battery_state", BatteryState, queue_size=10)
        self._percent = rospy.Publisher("battery_percent", Float32, queue_size=10)
        rospy.Subscriber("motor_power", Float32, self._on_power, queue_size=100)

    def _on_power(self, message: Float32) -> None:
        self._powers.append(message.data)

    def run(self) -> None:
        """Give power until shutdown."""
        rate = rospy.Rate(param("rate", 2))
        before = rospy.Time.now()
        while not rospy.is_shutdown():
            rate.sleep()
            now = rospy.Time.now()
            self._model.give(self._idle + self._mean_power(), (now - before).to_sec())
            self._publish(now)
            before = now

    def _mean_power(self) -> float:
        """Return the mean of the motors' power since the last call; without a message, the mean before."""
        powers, self._powers = self._powers, []
        if powers:
            self._power = sum(powers) / len(powers)
        return self._power

    def _publish(self, now: rospy.Time) -> None:
        model = self._model
        state = BatteryState(voltage=model.voltage, current=-model.current, percentage=model.charge, present=True)
        state.header.stamp = now
        state.charge, state.capacity = model.charge * model.capacity_ah, model.capacity_ah
        state.design_capacity = model.capacity_ah
        state.temperature = float("nan")
        state.power_supply_status = BatteryState.POWER_SUPPLY_STATUS_DISCHARGING
        state.power_supply_health = BatteryState.POWER_SUPPLY_HEALTH_GOOD
        state.power_supply_technology = BatteryState.POWER_SUPPLY_TECHNOLOGY_LION
        self._state.publish(state)
        self._percent.publish(100 * model.charge)


def main() -> None:
    rospy.init_node("battery")
    Battery().run()


if __name__ == "__main__":
    with contextlib.suppress(rospy.ROSInterruptException):
        main()
