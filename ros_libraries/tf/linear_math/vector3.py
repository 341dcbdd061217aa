"""Vector3.h: points and vectors. Imports tf.linear_math.quad_word and scalar."""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, sin, sqrt

from tf.linear_math.quad_word import QuadWord
from tf.linear_math.scalar import TFSIMD_EPSILON, TFSIMDSQRT12, tfAcos, tfRecipSqrt


class Vector3(QuadWord):
    """A point or a vector; iterating gives x, y, z.

    Args:
        x, y, z: its coordinates.
    """

    __slots__ = ()

    def __init__(self, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> None:
        super().__init__(x, y, z)

    def __iter__(self) -> Iterator[float]:
        return iter(self.m_floats[:3])

    # -- arithmetic: with vectors by element, with numbers by scaling ------------------------------------------------

    def __add__(self, other: Vector3) -> Vector3:
        return Vector3(*(a + b for a, b in zip(self, other, strict=True)))

    def __sub__(self, other: Vector3) -> Vector3:
        return Vector3(*(a - b for a, b in zip(self, other, strict=True)))

    def __neg__(self) -> Vector3:
        return Vector3(*(-a for a in self))

    def __mul__(self, other: Vector3 | float) -> Vector3:
        if isinstance(other, Vector3):
            return Vector3(*(a * b for a, b in zip(self, other, strict=True)))
        return Vector3(*(a * other for a in self)) if isinstance(other, (int, float)) else NotImplemented

    __rmul__ = __mul__

    def __truediv__(self, other: Vector3 | float) -> Vector3:
        if isinstance(other, Vector3):
            return Vector3(*(a / b for a, b in zip(self, other, strict=True)))
        return self * (1.0 / other)

    def __iadd__(self, other: Vector3) -> Vector3:
        return self._take(self + other)

    def __isub__(self, other: Vector3) -> Vector3:
        return self._take(self - other)

    def __imul__(self, other: Vector3 | float) -> Vector3:
        return self._take(self * other)

    def __itruediv__(self, other: Vector3 | float) -> Vector3:
        return self._take(self / other)

    def _take(self, other: Vector3) -> Vector3:
        self.m_floats[:3] = other
        return self

    # -- products and lengths ----------------------------------------------------------------------------------------

    def dot(self, v: Vector3) -> float:
        """Return the scalar product."""
        return self[0] * v[0] + self[1] * v[1] + self[2] * v[2]

    def cross(self, v: Vector3) -> Vector3:
        """Return the vector product."""
        (a, b, c), (d, e, f) = self, v
        return Vector3(b * f - c * e, c * d - a * f, a * e - b * d)

    def triple(self, v1: Vector3, v2: Vector3) -> float:
        """Return the volume that this vector spans with two others."""
        return self.dot(v1.cross(v2))

    def length2(self) -> float:
        """Return the square of the length."""
        return self.dot(self)

    def length(self) -> float:
        """Return the length."""
        return sqrt(self.length2())

    def distance2(self, v: Vector3) -> float:
        """Return the square of the distance to another point."""
        return (v - self).length2()

    def distance(self, v: Vector3) -> float:
        """Return the distance to another point."""
        return (v - self).length()

    def angle(self, v: Vector3) -> float:
        """Return the angle to another vector, in rad."""
        return tfAcos(self.dot(v) / sqrt(self.length2() * v.length2()))

    def normalize(self) -> Vector3:
        """Give this vector length 1, and return it."""
        self /= self.length()
        return self

    def normalized(self) -> Vector3:
        """Return a vector of length 1 in this direction."""
        return self / self.length()

    def rotate(self, wAxis: Vector3, angle: float) -> Vector3:
        """Return this vector turned about an axis.

        Args:
            wAxis: the axis, of length 1.
            angle: in rad.
        """
        along = wAxis * wAxis.dot(self)
        return along + (self - along) * cos(angle) + wAxis.cross(self) * sin(angle)

    # -- elements ----------------------------------------------------------------------------------------------------

    def absolute(self) -> Vector3:
        """Return the vector of the absolute values."""
        return Vector3(*map(abs, self))

    def minAxis(self) -> int:
        """Return the index of the smallest element."""
        x, y, z = self
        if x < y:
            return 0 if x < z else 2
        return 1 if y < z else 2

    def maxAxis(self) -> int:
        """Return the index of the largest element."""
        x, y, z = self
        if x < y:
            return 2 if y < z else 1
        return 2 if x < z else 0

    def furthestAxis(self) -> int:
        """Return the index of the axis that this vector is furthest from."""
        return self.absolute().minAxis()

    def closestAxis(self) -> int:
        """Return the index of the axis that this vector is closest to."""
        return self.absolute().maxAxis()

    def setInterpolate3(self, v0: Vector3, v1: Vector3, rt: float) -> None:
        """Become the point between two: v0 for `rt` 0, v1 for 1."""
        s = 1.0 - rt
        self.m_floats[:3] = (s * a + rt * b for a, b in zip(v0, v1, strict=True))

    def lerp(self, v: Vector3, t: float) -> Vector3:
        """Return the point between this and another: this for `t` 0, the other for 1."""
        return Vector3(*(a + (b - a) * t for a, b in zip(self, v, strict=True)))

    def getSkewSymmetricMatrix(self) -> tuple[Vector3, Vector3, Vector3]:
        """Return the rows of the matrix that makes the vector product with this vector."""
        x, y, z = self
        return Vector3(0.0, -z, y), Vector3(z, 0.0, -x), Vector3(-y, x, 0.0)

    def setZero(self) -> None:
        """Become (0, 0, 0)."""
        self.setValue(0.0, 0.0, 0.0)

    def isZero(self) -> bool:
        """Return whether all elements are 0."""
        return not any(self)

    def fuzzyZero(self) -> bool:
        """Return whether the length is almost 0."""
        return self.length2() < TFSIMD_EPSILON


def tfDot(v1: Vector3, v2: Vector3) -> float:
    """Return the scalar product."""
    return v1.dot(v2)


def tfCross(v1: Vector3, v2: Vector3) -> Vector3:
    """Return the vector product."""
    return v1.cross(v2)


def tfTriple(v1: Vector3, v2: Vector3, v3: Vector3) -> float:
    """Return the volume that three vectors span."""
    return v1.triple(v2, v3)


def tfDistance2(v1: Vector3, v2: Vector3) -> float:
    """Return the square of the distance of two points."""
    return v1.distance2(v2)


def tfDistance(v1: Vector3, v2: Vector3) -> float:
    """Return the distance of two points."""
    return v1.distance(v2)


def tfAngle(v1: Vector3, v2: Vector3) -> float:
    """Return the angle of two vectors, in rad."""
    return v1.angle(v2)


def lerp(v1: Vector3, v2: Vector3, t: float) -> Vector3:
    """Return the point between two: v1 for `t` 0, v2 for 1."""
    return v1.lerp(v2, t)


def tfPlaneSpace1(n: Vector3) -> tuple[Vector3, Vector3]:
    """Return two vectors that span the plane orthogonal to `n`, which has length 1."""
    x, y, z = n
    if abs(z) > TFSIMDSQRT12:
        a = y * y + z * z
        k = tfRecipSqrt(a)
        p = Vector3(0.0, -z * k, y * k)
        return p, Vector3(a * k, -x * p[2], x * p[1])
    a = x * x + y * y
    k = tfRecipSqrt(a)
    p = Vector3(-y * k, x * k, 0.0)
    return p, Vector3(-z * p[1], z * p[0], a * k)
