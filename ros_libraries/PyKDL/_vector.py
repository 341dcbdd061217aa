"""`Vector`: a point or a direction."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

EPSILON = 1e-6
"""What counts as equal, or as zero, where nothing else is said (KDL::epsilon)."""


def columns(values: Iterable[float]) -> str:
    """Numbers as C++ streams write them, in the columns of KDL."""
    return ",".join(f"{value:12.6g}" for value in values)


def near(a: Iterable[float], b: Iterable[float], eps: float = EPSILON) -> bool:
    """Return whether numbers are pairwise less than `eps` apart."""
    return all(abs(one - other) < eps for one, other in zip(a, b, strict=True))


class Vector:
    """Three numbers: `Vector()`, `Vector(x, y, z)` or a copy of another one.

    `*` with a number scales; with a vector it is the cross product. Two vectors are equal if no component differs by
    more than `EPSILON`.
    """

    def __init__(self, *args: Any) -> None:
        if len(args) == 1:
            args = tuple(args[0].v)
        elif len(args) not in (0, 3):
            raise TypeError("Vector() takes nothing, three numbers or a Vector")
        self.v: list[float] = [float(value) for value in args or (0, 0, 0)]

    def x(self, value: float | None = None) -> float | None:
        """Return the first component, or set it if a value is given."""
        return self._component(0, value)

    def y(self, value: float | None = None) -> float | None:
        """Return the second component, or set it if a value is given."""
        return self._component(1, value)

    def z(self, value: float | None = None) -> float | None:
        """Return the third component, or set it if a value is given."""
        return self._component(2, value)

    def _component(self, index: int, value: float | None) -> float | None:
        if value is None:
            return self.v[index]
        self.v[index] = float(value)
        return None

    def __getitem__(self, index: int) -> float:
        return self.v[_checked(index)]

    def __setitem__(self, index: int, value: float) -> None:
        self.v[_checked(index)] = float(value)

    def __repr__(self) -> str:
        return f"[{columns(self.v)}]"

    def __copy__(self) -> Vector:
        return Vector(self)

    def __deepcopy__(self, memo: Any) -> Vector:
        return Vector(self)

    def __add__(self, other: Any) -> Any:
        return Vector(*map(sum, zip(self.v, other.v, strict=True))) if isinstance(other, Vector) else NotImplemented

    def __sub__(self, other: Any) -> Any:
        return self + -other if isinstance(other, Vector) else NotImplemented

    def __iadd__(self, other: Any) -> Vector:
        self.v = (self + other).v
        return self

    def __isub__(self, other: Any) -> Vector:
        self.v = (self - other).v
        return self

    def __neg__(self) -> Vector:
        return Vector(self * -1.0)

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, Vector):
            (ax, ay, az), (bx, by, bz) = self.v, other.v
            return Vector(ay * bz - az * by, az * bx - ax * bz, ax * by - ay * bx)
        return Vector(*(value * other for value in self.v)) if isinstance(other, (int, float)) else NotImplemented

    __rmul__ = __mul__

    def __truediv__(self, other: float) -> Vector:
        return Vector(*(value / other for value in self.v))

    def __eq__(self, other: object) -> bool:
        return near(self.v, other.v) if isinstance(other, Vector) else NotImplemented

    def __hash__(self) -> int:
        return hash(tuple(self.v))

    def ReverseSign(self) -> None:
        """Turn it round, in place."""
        self.v = (-self).v

    def Norm(self, eps: float = EPSILON) -> float:
        """Return its length, or 0 if every component is smaller than `eps`."""
        return math.hypot(*self.v) if max(map(abs, self.v)) >= eps else 0.0

    def Normalize(self, eps: float = EPSILON) -> float:
        """Scale it to length 1 in place. A vector shorter than `eps` becomes (1, 0, 0).

        Returns:
            the previous length, or 0.
        """
        length = self.Norm()
        if length < eps:
            self.v = [1.0, 0.0, 0.0]
            return 0.0
        self.v = (self / length).v
        return length

    @staticmethod
    def Zero() -> Vector:
        """(0, 0, 0)."""
        return Vector()


def scalar_product(a: Vector, b: Vector) -> float:
    """Return the sum of the products of components."""
    return sum(one * other for one, other in zip(a.v, b.v, strict=True))


def _checked(index: int) -> int:
    if not 0 <= index <= 2:
        raise IndexError("Vector index out of range")
    return index
