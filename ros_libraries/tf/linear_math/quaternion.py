"""Quaternion.h: rotations as quaternions. Imports tf.linear_math."""

from __future__ import annotations

from math import cos, sin, sqrt
from typing import overload

from tf.linear_math.quad_word import QuadWord
from tf.linear_math.scalar import TFSIMD_EPSILON, tfAcos
from tf.linear_math.vector3 import Vector3, tfPlaneSpace1

Halves = tuple[float, float, float, float, float, float]


class Quaternion(QuadWord):
    """A rotation, `Quaternion(x, y, z, w)` or `Quaternion(axis, angle)`; the identity without arguments.

    Three numbers are yaw, pitch, roll as in `setEuler`.
    """

    __slots__ = ()

    @overload
    def __init__(self) -> None: ...
    @overload
    def __init__(self, axis: Vector3, angle: float, /) -> None: ...
    @overload
    def __init__(self, x: float, y: float, z: float, w: float = ..., /) -> None: ...
    def __init__(self, *values: Vector3 | float) -> None:
        super().__init__(0.0, 0.0, 0.0, 1.0)
        numbers = [value for value in values if not isinstance(value, Vector3)]
        if len(numbers) == 1 and isinstance(values[0], Vector3):
            self.setRotation(values[0], numbers[0])
        elif len(numbers) == 3:
            self.setEuler(*numbers)
        elif numbers:
            self.setValue(*numbers)

    # -- setting -----------------------------------------------------------------------------------------------------

    def setRotation(self, axis: Vector3, angle: float) -> None:
        """Become a rotation about an axis of any length, by an angle in rad."""
        s = sin(angle * 0.5) / axis.length()
        self.setValue(axis[0] * s, axis[1] * s, axis[2] * s, cos(angle * 0.5))

    def setEuler(self, yaw: float, pitch: float, roll: float) -> None:
        """Become a rotation by angles in rad about Y (yaw), X (pitch) and Z (roll)."""
        cy, sy, cp, sp, cr, sr = _halves(yaw, pitch, roll)
        self.setValue(
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
            sr * cp * cy - cr * sp * sy,
            cr * cp * cy + sr * sp * sy,
        )

    def setRPY(self, roll: float, pitch: float, yaw: float) -> None:
        """Become a rotation by angles in rad about the fixed axes X, Y and Z."""
        cy, sy, cp, sp, cr, sr = _halves(yaw, pitch, roll)
        self.setValue(
            sr * cp * cy - cr * sp * sy,
            cr * sp * cy + sr * cp * sy,
            cr * cp * sy - sr * sp * cy,
            cr * cp * cy + sr * sp * sy,
        )

    def setEulerZYX(self, yaw: float, pitch: float, roll: float) -> None:
        """Set the rotation; this is the old form of `setRPY`, with the arguments in reverse order."""
        self.setRPY(roll, pitch, yaw)

    # -- arithmetic --------------------------------------------------------------------------------------------------

    def __add__(self, other: Quaternion) -> Quaternion:
        return _made(a + b for a, b in zip(self, other, strict=True))

    def __sub__(self, other: Quaternion) -> Quaternion:
        return _made(a - b for a, b in zip(self, other, strict=True))

    def __neg__(self) -> Quaternion:
        return _made(-a for a in self)

    def __mul__(self, other: Quaternion | Vector3 | float) -> Quaternion:
        if isinstance(other, QuadWord):
            return _product(self, other)
        return _made(a * other for a in self) if isinstance(other, (int, float)) else NotImplemented

    def __rmul__(self, other: Vector3) -> Quaternion:
        return _product(other, self) if isinstance(other, Vector3) else NotImplemented

    def __truediv__(self, other: float) -> Quaternion:
        return self * (1.0 / other)

    def __iadd__(self, other: Quaternion) -> Quaternion:
        return self._take(self + other)

    def __isub__(self, other: Quaternion) -> Quaternion:
        return self._take(self - other)

    def __imul__(self, other: Quaternion | Vector3 | float) -> Quaternion:
        return self._take(self * other)

    def __itruediv__(self, other: float) -> Quaternion:
        return self._take(self / other)

    def _take(self, other: Quaternion) -> Quaternion:
        self.m_floats[:] = other
        return self

    def inverse(self) -> Quaternion:
        """Return the inverse rotation."""
        x, y, z, w = self
        return Quaternion(-x, -y, -z, w)

    # -- measuring ---------------------------------------------------------------------------------------------------

    def dot(self, q: Quaternion) -> float:
        """Return the scalar product."""
        return self[0] * q[0] + self[1] * q[1] + self[2] * q[2] + self[3] * q[3]

    def length2(self) -> float:
        """Return the square of the length."""
        return self.dot(self)

    def length(self) -> float:
        """Return the length."""
        return sqrt(self.length2())

    def normalize(self) -> Quaternion:
        """Give this quaternion length 1, and return it."""
        self /= self.length()
        return self

    def normalized(self) -> Quaternion:
        """Return this quaternion with length 1."""
        return self / self.length()

    def angle(self, q: Quaternion) -> float:
        """Return half the angle to another rotation, in rad."""
        return tfAcos(self.dot(q) / sqrt(self.length2() * q.length2()))

    def angleShortestPath(self, q: Quaternion) -> float:
        """Return the angle to another rotation along the shortest path, in rad."""
        return tfAcos(abs(self.dot(q)) / sqrt(self.length2() * q.length2())) * 2.0

    def getAngle(self) -> float:
        """Return the angle of the rotation, 0 to 2 pi rad."""
        return 2.0 * tfAcos(self[3])

    def getAngleShortestPath(self) -> float:
        """Return the angle of the rotation along the shortest path, 0 to pi rad."""
        return 2.0 * tfAcos(abs(self[3]))

    def getAxis(self) -> Vector3:
        """Return the axis of the rotation, or X without rotation."""
        sine2 = 1.0 - self[3] * self[3]
        if sine2 < 10.0 * TFSIMD_EPSILON:
            return Vector3(1.0, 0.0, 0.0)
        sine = sqrt(sine2)
        return Vector3(self[0] / sine, self[1] / sine, self[2] / sine)

    # -- two rotations -----------------------------------------------------------------------------------------------

    def farthest(self, qd: Quaternion) -> Quaternion:
        """Return the one of `qd` and -`qd` that is farther away."""
        difference, total = self - qd, self + qd
        return qd if difference.length2() > total.length2() else -qd

    def nearest(self, qd: Quaternion) -> Quaternion:
        """Return the one of `qd` and -`qd` that is nearer."""
        difference, total = self - qd, self + qd
        return qd if difference.length2() < total.length2() else -qd

    def slerp(self, q: Quaternion, t: float) -> Quaternion:
        """Return the rotation between this and another, at constant speed: this for `t` 0, the other for 1."""
        theta = self.angleShortestPath(q) / 2.0
        if theta == 0.0:
            return _made(self)
        d, s0, s1 = 1.0 / sin(theta), sin((1.0 - t) * theta), sin(t * theta)
        other = -q if self.dot(q) < 0 else q
        return _made((a * s0 + b * s1) * d for a, b in zip(self, other, strict=True))

    @staticmethod
    def getIdentity() -> Quaternion:
        """Return the identity."""
        return Quaternion()


def _halves(yaw: float, pitch: float, roll: float) -> Halves:
    """Return cosine and sine of half of each angle."""
    y, p, r = yaw * 0.5, pitch * 0.5, roll * 0.5
    return cos(y), sin(y), cos(p), sin(p), cos(r), sin(r)


def _made(numbers: object) -> Quaternion:
    found = Quaternion()
    found.m_floats[:] = numbers  # type: ignore[call-overload]  # any iterable of four numbers
    return found


def _product(a: QuadWord, b: QuadWord) -> Quaternion:
    """Return the product. A vector counts as a quaternion whose w is 0."""
    ax, ay, az, aw = a.m_floats
    bx, by, bz, bw = b.m_floats
    return Quaternion(
        aw * bx + ax * bw + ay * bz - az * by,
        aw * by + ay * bw + az * bx - ax * bz,
        aw * bz + az * bw + ax * by - ay * bx,
        aw * bw - ax * bx - ay * by - az * bz,
    )


def dot(q1: Quaternion, q2: Quaternion) -> float:
    """Return the scalar product."""
    return q1.dot(q2)


def length(q: Quaternion) -> float:
    """Return the length."""
    return q.length()


def angle(q1: Quaternion, q2: Quaternion) -> float:
    """Return half the angle of two rotations, in rad."""
    return q1.angle(q2)


def angleShortestPath(q1: Quaternion, q2: Quaternion) -> float:
    """Return the angle of two rotations along the shortest path, in rad."""
    return q1.angleShortestPath(q2)


def inverse(q: Quaternion) -> Quaternion:
    """Return the inverse rotation."""
    return q.inverse()


def slerp(q1: Quaternion, q2: Quaternion, t: float) -> Quaternion:
    """Return the rotation between two: q1 for `t` 0, q2 for 1."""
    return q1.slerp(q2, t)


def quatRotate(rotation: Quaternion, v: Vector3) -> Vector3:
    """Return a vector, turned."""
    turned = rotation * v * rotation.inverse()
    return Vector3(turned[0], turned[1], turned[2])


def shortestArcQuat(v0: Vector3, v1: Vector3) -> Quaternion:
    """Return the rotation that turns one vector of length 1 to another."""
    c, d = v0.cross(v1), v0.dot(v1)
    if d < -1.0 + TFSIMD_EPSILON:
        across, _ = tfPlaneSpace1(v0)
        return Quaternion(across[0], across[1], across[2], 0.0)
    s = sqrt((1.0 + d) * 2.0)
    return Quaternion(c[0] / s, c[1] / s, c[2] / s, s * 0.5)


def shortestArcQuatNormalize2(v0: Vector3, v1: Vector3) -> Quaternion:
    """Return the rotation that turns one vector to another. Both are scaled to length 1."""
    return shortestArcQuat(v0.normalize(), v1.normalize())
