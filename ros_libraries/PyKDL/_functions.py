"""The functions of PyKDL that take several kinds of arguments."""

from __future__ import annotations

from typing import Any

from ._frame import Frame
from ._joint_arrays import Jacobian, JntArray
from ._rotation import Rotation
from ._twist import Twist
from ._vector import EPSILON, Vector, near, scalar_product


def Equal(a: Any, b: Any, eps: float = EPSILON) -> bool:
    """Return whether two of a kind differ by less than `eps` in each number."""
    return near(_numbers(a), _numbers(b), eps)


def _numbers(value: Any) -> list[float]:
    if isinstance(value, Frame):
        return [*value.M.m, *value.p.v]
    if isinstance(value, Rotation):
        return value.m
    if isinstance(value, JntArray):
        return value.q
    return value.v if isinstance(value, Vector) else [value[at] for at in range(6)]


def SetToZero(value: Any) -> None:
    """Make all numbers of a Vector, Twist, Wrench, JntArray or Jacobian 0, in place."""
    if isinstance(value, JntArray):
        value.q = [0.0] * len(value.q)
    elif isinstance(value, Jacobian):
        value.twists = [Twist() for _ in value.twists]
    else:
        for at in range(3 if isinstance(value, Vector) else 6):
            value[at] = 0.0


def dot(a: Any, b: Any) -> float:
    """Return the scalar product of two vectors, or of a Twist and a Wrench, which is power."""
    if isinstance(a, Vector):
        return scalar_product(a, b)
    twist, wrench = (a, b) if isinstance(a, Twist) else (b, a)
    return scalar_product(twist.vel, wrench.force) + scalar_product(twist.rot, wrench.torque)


def diff(a: Any, b: Any, dt: float = 1) -> Any:
    """Return the motion that takes `a` to `b` in a time: a Vector for Vectors and Rotations, a Twist for Frames."""
    if isinstance(a, Rotation):
        return a * (a.Inverse() * b).GetRot() / dt
    if isinstance(a, Frame):
        return Twist(diff(a.p, b.p, dt), diff(a.M, b.M, dt))
    return (b - a) / dt


def addDelta(a: Any, da: Any, dt: float = 1) -> Any:
    """Return `a` after a motion `da` for a time. This is the reverse of `diff`."""
    if isinstance(a, Rotation):
        return a * Rotation.Rot(a.Inverse(da), da.Norm() * dt)
    if isinstance(a, Frame):
        return Frame(addDelta(a.M, da.rot, dt), addDelta(a.p, da.vel, dt))
    return a + da * dt


def Add(src1: JntArray, src2: JntArray, dest: JntArray) -> None:
    """Set `dest` to a sum."""
    dest.q = [one + other for one, other in zip(src1.q, src2.q, strict=True)]


def Subtract(src1: JntArray, src2: JntArray, dest: JntArray) -> None:
    """Set `dest` to a difference."""
    dest.q = [one - other for one, other in zip(src1.q, src2.q, strict=True)]


def Multiply(src: JntArray, factor: float, dest: JntArray) -> None:
    """Set `dest` to a multiple."""
    dest.q = [value * factor for value in src.q]


def Divide(src: JntArray, factor: float, dest: JntArray) -> None:
    """Set `dest` to a fraction."""
    dest.q = [value / factor for value in src.q]


def MultiplyJacobian(jac: Jacobian, src: JntArray, dest: Twist) -> None:
    """Set `dest` to the twist that joint velocities make."""
    total = sum((twist * speed for twist, speed in zip(jac.twists, src.q, strict=True)), Twist())
    dest.vel, dest.rot = total.vel, total.rot
