"""The arm of both control nodes: joints, drives and geometry.

A plain Python module beside the node scripts, imported by `arm_control.py` and `main_control.py`, so that the plant
and the controller start from one set of figures. Every figure is a default: `joint_values` lets a private ROS
parameter (`~inertia`, `~viscous_friction`, ...) replace it with one number for all joints or with one per joint.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import rospy

JOINT_NAMES = (
    "shoulder_roll",
    "shoulder_pitch",
    "upper_arm_roll",
    "elbow_pitch",
    "forearm_roll",
    "wrist_pitch",
    "hand_roll",
)
JOINTS = len(JOINT_NAMES)

INERTIA = (4.0, 4.0, 2.0, 1.5, 0.6, 0.5, 0.2)  # kg m^2, seen at the joint
VISCOUS_FRICTION = (8.0, 8.0, 5.0, 4.0, 2.0, 1.5, 0.8)  # N m s/rad
TORQUE_CONSTANT = (2.0, 2.0, 1.5, 1.5, 0.8, 0.8, 0.4)  # N m/A at the joint: motor constant times gear ratio

STOWED = (0.0, -1.2, 0.0, 2.2, 0.0, -1.0, 0.0)  # rad


class Vector(NamedTuple):
    """A direction or a place in the frame of the arm's base (m)."""

    x: float
    y: float
    z: float


class Quaternion(NamedTuple):
    """An orientation, in the order of geometry_msgs/Quaternion."""

    x: float
    y: float
    z: float
    w: float


ROLL = Vector(0.0, 0.0, 1.0)
PITCH = Vector(0.0, 1.0, 0.0)
CHAIN = (  # axis of each joint, and metres along the arm to the next one
    (ROLL, 0.30),
    (PITCH, 0.45),
    (ROLL, 0.45),
    (PITCH, 0.40),
    (ROLL, 0.40),
    (PITCH, 0.15),
    (ROLL, 0.20),
)


def joint_values(param: str, default: Sequence[float]) -> list[float]:
    """Return seven floats from a ROS parameter that holds a number or a list of seven; raise ValueError otherwise."""
    value = rospy.get_param(param, list(default))
    values = [float(entry) for entry in value] if isinstance(value, list) else [float(value)] * JOINTS
    if len(values) != JOINTS or not all(math.isfinite(entry) for entry in values):
        raise ValueError(f"parameter {param}: give one finite number or {JOINTS} of them, not {value!r}")
    return values


def positive_joint_values(param: str, default: Sequence[float]) -> list[float]:
    """Like `joint_values`, for quantities that the model divides by."""
    values = joint_values(param, default)
    if min(values) <= 0.0:
        raise ValueError(f"parameter {param}: every value must be above zero, not {values!r}")
    return values


def hand_pose(joints: Sequence[float]) -> tuple[Vector, Quaternion]:
    """Forward kinematics: where the hand is (m) and how it is turned, in the frame of the arm's base."""
    place = Vector(0.0, 0.0, 0.0)
    turn = Quaternion(0.0, 0.0, 0.0, 1.0)
    for angle, (axis, length) in zip(joints, CHAIN):
        turn = _multiply(turn, rotation(axis, angle))
        link = _z_axis(turn)
        place = Vector(place.x + length * link.x, place.y + length * link.y, place.z + length * link.z)
    return place, turn


def rotation(axis: Vector, angle: float) -> Quaternion:
    """A turn by an angle (rad) about an axis."""
    sine = math.sin(0.5 * angle)
    return Quaternion(axis.x * sine, axis.y * sine, axis.z * sine, math.cos(0.5 * angle))


def _multiply(a: Quaternion, b: Quaternion) -> Quaternion:
    return Quaternion(
        a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
        a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
        a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w,
        a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z,
    )


def _z_axis(q: Quaternion) -> Vector:
    """Where the rotation takes the unit vector z."""
    return Vector(2.0 * (q.x * q.z + q.w * q.y), 2.0 * (q.y * q.z - q.w * q.x), 1.0 - 2.0 * (q.x * q.x + q.y * q.y))
