#!/usr/bin/env python3
"""Main control node: moves the arm through a debris capture and commands its motors at 1 kHz.

Once the first joint state is in, the arm goes from wherever it is through three waypoints: it *approaches* a standoff
pose, closes in to *grasp*, and *retracts* with the debris to the berth, where it *holds*. Each leg is a minimum-jerk
curve (at rest at both ends). The control law is computed torque: the reference's own acceleration and friction are
fed forward, and what is left of the error decays like a damped oscillator of ~natural_frequency and ~damping.

Subscribes: `joint_states` (sensor_msgs/JointState)
Publishes:  `motor_command` (std_msgs/Float64MultiArray at ~rate, one motor current per joint, A)
            `hand_pose` (geometry_msgs/PoseStamped at ~status_rate), `phase` (std_msgs/String, latched, on change)
Parameters: ~rate 1000 Hz, ~status_rate 10 Hz, ~natural_frequency 20 rad/s, ~damping 1, ~inertia, ~viscous_friction,
            ~torque_constant, ~standoff, ~contact, ~berth (7 rad each), ~approach_time 7 s, ~grasp_time 4 s,
            ~retract_time 7 s, ~tolerance 0.001 rad
"""

from __future__ import annotations

import contextlib
import math
from collections.abc import Iterator, Sequence

import rospy
from arm_description import (
    INERTIA,
    JOINTS,
    TORQUE_CONSTANT,
    VISCOUS_FRICTION,
    hand_pose,
    joint_values,
    positive_joint_values,
)
from geometry_msgs.msg import Point, PoseStamped, Quaternion
from sensor_msgs.msg import JointState
from std_msgs.msg import Float64MultiArray, MultiArrayDimension, String

STANDOFF = (0.6, -0.3, 0.3, 1.4, -0.4, 0.5, 0.8)  # rad: hand in front of the debris
CONTACT = (0.6, 0.1, 0.3, 0.9, -0.4, 0.6, 1.2)  # rad: fingers around it
BERTH = (-0.5, -0.9, 0.0, 1.9, 0.2, -0.4, 0.0)  # rad: debris over the stowage bay
SETTLING_TIME = 1.0  # s after the last leg before the result is judged


class Leg:
    """A minimum-jerk curve from one pose to another, lasting `duration` seconds from mission time `begin`."""

    def __init__(
        self, phase: str, start: Sequence[float], goal: Sequence[float], begin: float, duration: float
    ) -> None:
        self.phase = phase
        self.begin = begin
        self.end = begin + duration
        self.duration = duration
        self.start = start
        self.goal = goal
        self.span = [q1 - q0 for q0, q1 in zip(start, goal)]


class ComputedTorque:
    """The control law, with its model of the drives folded into gains of A per rad, rad/s and rad/s^2."""

    def __init__(self) -> None:
        frequency = float(rospy.get_param("~natural_frequency", 20.0))
        damping = float(rospy.get_param("~damping", 1.0))
        drives = zip(
            positive_joint_values("~inertia", INERTIA),
            positive_joint_values("~viscous_friction", VISCOUS_FRICTION),
            positive_joint_values("~torque_constant", TORQUE_CONSTANT),
        )
        gains = [(inertia / torque, friction / torque) for inertia, friction, torque in drives]
        self._inertia = [inertia for inertia, _ in gains]
        self._stiffness = [inertia * frequency * frequency for inertia, _ in gains]
        self._drag = [2.0 * inertia * damping * frequency for inertia, _ in gains]
        # What the reference's speed asks for: its own friction, and the part that the drag takes off.
        self._feed = [drag + friction for drag, (_, friction) in zip(self._drag, gains)]

    def currents(self, leg: Leg, now: float, position: Sequence[float], velocity: Sequence[float]) -> list[float]:
        """Return the motor currents (A) that move the joints along the leg at mission time `now` (s)."""
        duration = leg.duration
        x = (now - leg.begin) / duration
        if x >= 1.0:
            x = 1.0
        # Share of the way, and its first two derivatives: 10x^3 - 15x^4 + 6x^5.
        rest = 1.0 - x
        way = x * x * x * (10.0 - x * (15.0 - 6.0 * x))
        pace = 30.0 * x * x * rest * rest / duration
        surge = 60.0 * x * rest * (rest - x) / (duration * duration)
        return [
            stiffness * (start - q) - drag * v + span * (stiffness * way + feed * pace + inertia * surge)
            for start, span, q, v, stiffness, drag, feed, inertia in zip(
                leg.start, leg.span, position, velocity, self._stiffness, self._drag, self._feed, self._inertia
            )
        ]


class MainControl:
    """The node: latest joint state in, control law, motor command out, once per cycle."""

    def __init__(self) -> None:
        self._rate = rospy.Rate(float(rospy.get_param("~rate", 1000.0)))
        self._tolerance = float(rospy.get_param("~tolerance", 1e-3))
        self._law = ComputedTorque()
        self._waypoints = [
            ("approach", joint_values("~standoff", STANDOFF), float(rospy.get_param("~approach_time", 7.0))),
            ("grasp", joint_values("~contact", CONTACT), float(rospy.get_param("~grasp_time", 4.0))),
            ("retract", joint_values("~berth", BERTH), float(rospy.get_param("~retract_time", 7.0))),
        ]
        self._state: JointState | None = None
        self._command_publisher = rospy.Publisher("motor_command", Float64MultiArray, queue_size=1)
        self._pose_publisher = rospy.Publisher("hand_pose", PoseStamped, queue_size=1)
        self._phase_publisher = rospy.Publisher("phase", String, queue_size=1, latch=True)
        rospy.Subscriber("joint_states", JointState, self._on_state, queue_size=1, tcp_nodelay=True)
        period = rospy.Duration(1.0 / float(rospy.get_param("~status_rate", 10.0)))
        self._status_timer = rospy.Timer(period, self._publish_pose)

    def _on_state(self, message: JointState) -> None:
        self._state = message

    def _publish_pose(self, _event: object) -> None:
        state = self._state
        if state is None:
            return
        position, orientation = hand_pose(state.position)
        status = PoseStamped()
        status.header.stamp = state.header.stamp
        status.header.frame_id = "arm_base"
        status.pose.position = Point(*position)
        status.pose.orientation = Quaternion(*orientation)
        self._pose_publisher.publish(status)

    def _plan(self, start: Sequence[float]) -> list[Leg]:
        legs: list[Leg] = []
        begin = 0.0
        for phase, goal, seconds in self._waypoints:
            legs.append(Leg(phase, start, goal, begin, seconds))
            start, begin = goal, legs[-1].end
        legs.append(Leg("hold", start, start, begin, SETTLING_TIME))
        return legs

    def _enter(self, leg: Leg) -> None:
        self._phase_publisher.publish(String(data=leg.phase))
        rospy.loginfo("phase %s", leg.phase)

    def _judge(self, goal: Sequence[float], position: Sequence[float]) -> None:
        error = max(abs(q1 - q) for q1, q in zip(goal, position))
        verdict = rospy.loginfo if error < self._tolerance else rospy.logerr
        verdict("capture complete: largest joint error %.6f rad (tolerance %g)", error, self._tolerance)

    def _first_state(self) -> JointState | None:
        """Wait for the arm's first report. Returns None if the node is shut down before."""
        while self._state is None and not rospy.is_shutdown():
            self._rate.sleep()
        return self._state

    def run(self) -> None:
        """Fly the capture, then hold the berth until shutdown."""
        state = self._first_state()
        if state is None:
            return
        # Mission time is the time of the encoders' samples: a late sample is compared with where it should have been.
        start_time = state.header.stamp.to_sec()
        following = iter(self._plan(state.position))
        leg = next(following)
        self._enter(leg)
        currents = self._law.currents
        command = Float64MultiArray()
        command.layout.dim = [MultiArrayDimension(label="joint", size=JOINTS, stride=JOINTS)]
        while not rospy.is_shutdown():
            state = self._state
            now = state.header.stamp.to_sec() - start_time
            # publish() serialises before it returns, so one message object serves every cycle.
            command.data = currents(leg, now, state.position, state.velocity)
            self._command_publisher.publish(command)
            if now >= leg.end:
                leg = self._after(leg, following, state.position)
            self._rate.sleep()

    def _after(self, leg: Leg, following: Iterator[Leg], position: Sequence[float]) -> Leg:
        """Return the next leg, or a leg that holds the last goal."""
        successor = next(following, None)
        if successor is None:
            self._judge(leg.goal, position)
            return Leg("hold", leg.goal, leg.goal, leg.end, math.inf)
        self._enter(successor)
        return successor


def main() -> None:
    rospy.init_node("main_control")
    MainControl().run()


if __name__ == "__main__":
    with contextlib.suppress(rospy.ROSInterruptException):
        main()
