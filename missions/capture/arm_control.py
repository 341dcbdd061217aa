#!/usr/bin/env python3
"""Robot-arm control node: follows motor commands, reports the joints at 1 kHz.

It stands where the drive electronics of a seven-joint arm would be. Each joint is an inertia with viscous friction
behind a current-limited motor, read by an absolute encoder. Between two cycles the current is constant, so that the
motion of a joint has a closed form and the model is exact at any rate.

Subscribes: `motor_command` (std_msgs/Float64MultiArray, seven motor currents, A)
Publishes:  `joint_states` (sensor_msgs/JointState at ~rate; effort carries the motor current, A)
            `joint_states_throttle` (the same sample at ~slow_rate, for displays and health monitoring)
Parameters: ~rate 1000 Hz, ~slow_rate 10 Hz, ~inertia, ~viscous_friction, ~torque_constant, ~initial_position,
            ~current_limit 5 A, ~encoder_bits 20, ~command_timeout 0.1 s
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Sequence

import rospy
from arm_description import (
    INERTIA,
    JOINT_NAMES,
    JOINTS,
    STOWED,
    TORQUE_CONSTANT,
    VISCOUS_FRICTION,
    joint_values,
    positive_joint_values,
)
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray


class ArmModel:
    """Seven independent joints, stepped by `period` seconds at a time."""

    def __init__(self, period: float) -> None:
        self.position = joint_values("~initial_position", STOWED)
        self.velocity = [0.0] * JOINTS
        self.current: Sequence[float] = [0.0] * JOINTS
        self._limit = float(rospy.get_param("~current_limit", 5.0))
        self._encoder_step = 2.0 * math.pi / 2 ** int(rospy.get_param("~encoder_bits", 20))
        drives = zip(
            positive_joint_values("~inertia", INERTIA),
            positive_joint_values("~viscous_friction", VISCOUS_FRICTION),
            positive_joint_values("~torque_constant", TORQUE_CONSTANT),
        )
        self._keep, self._gain, self._glide, self._push = zip(*(self._discretise(*drive, period) for drive in drives))

    @staticmethod
    def _discretise(
        inertia: float, friction: float, torque_constant: float, period: float
    ) -> tuple[float, float, float, float]:
        """Solve `inertia * dv/dt = torque_constant * i - friction * v` over one period of constant current i.

        Returns the factors of (v, i) in the next velocity, then those in the change of position.
        """
        lost = -math.expm1(-friction / inertia * period)  # share of the speed that friction takes in one period
        glide = lost * inertia / friction
        gain = torque_constant / friction
        return 1.0 - lost, lost * gain, glide, (period - glide) * gain

    def step(self, command: Sequence[float]) -> None:
        """Advance by one period under the commanded currents, clipped to what the drives can deliver."""
        limit = self._limit
        if max(command) > limit or min(command) < -limit:
            command = [min(max(ampere, -limit), limit) for ampere in command]
        velocity = self.velocity
        self.position = [
            q + glide * v + push * i
            for q, v, i, glide, push in zip(self.position, velocity, command, self._glide, self._push)
        ]
        self.velocity = [keep * v + gain * i for v, i, keep, gain in zip(velocity, command, self._keep, self._gain)]
        self.current = command

    def encoder_readings(self) -> list[float]:
        """Return the joint angles that the encoders measure: the last whole count, in rad."""
        step = self._encoder_step
        return [q // step * step for q in self.position]


class ArmControl:
    """The node: latest command in, model step, joint state out, once per cycle."""

    def __init__(self) -> None:
        rate = float(rospy.get_param("~rate", 1000.0))
        self._rate = rospy.Rate(rate)
        self._slow_every = max(1, round(rate / float(rospy.get_param("~slow_rate", 10.0))))
        self._command_lifetime = max(1, round(rate * float(rospy.get_param("~command_timeout", 0.1))))
        self._arm = ArmModel(1.0 / rate)
        self._idle = [0.0] * JOINTS
        self._command: Sequence[float] = self._idle
        self._command_age = 0
        self._state_publisher = rospy.Publisher("joint_states", JointState, queue_size=1)
        self._slow_publisher = rospy.Publisher("joint_states_throttle", JointState, queue_size=1)
        rospy.Subscriber("motor_command", Float64MultiArray, self._on_command, queue_size=1, tcp_nodelay=True)

    def _on_command(self, message: Float64MultiArray) -> None:
        if len(message.data) != JOINTS:
            rospy.logerr_throttle(1.0, f"motor_command has {len(message.data)} values instead of {JOINTS}: ignored")
            return
        self._command = message.data
        self._command_age = 0

    def _live_command(self) -> Sequence[float]:
        """Return the latest command, or no current if the controller has stopped sending."""
        self._command_age += 1
        if self._command_age > self._command_lifetime and self._command is not self._idle:
            rospy.logwarn("motor_command has stopped: motors off")
            self._command = self._idle
        return self._command

    def run(self) -> None:
        """Cycle until shutdown."""
        arm = self._arm
        state = JointState(name=list(JOINT_NAMES))
        state.header.frame_id = "arm_base"
        header = state.header
        cycle = 0
        rospy.loginfo("arm ready: %d joints", JOINTS)
        while not rospy.is_shutdown():
            arm.step(self._live_command())
            header.stamp = rospy.Time.now()
            state.position = arm.encoder_readings()
            state.velocity = arm.velocity
            state.effort = arm.current
            # publish() serialises before it returns, so one message object serves every cycle.
            self._state_publisher.publish(state)
            if cycle % self._slow_every == 0:
                self._slow_publisher.publish(state)
            cycle += 1
            self._rate.sleep()


def main() -> None:
    rospy.init_node("arm_control")
    ArmControl().run()


if __name__ == "__main__":
    with contextlib.suppress(rospy.ROSInterruptException):
        main()
