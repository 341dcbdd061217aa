"""`RotationalInertia` and `RigidBodyInertia`: the inertia of rigid bodies."""

from __future__ import annotations

from typing import Any

from ._frame import Frame
from ._rotation import Rotation
from ._twist import Twist, Wrench
from ._vector import Vector, scalar_product


class RotationalInertia:
    """A symmetric 3x3 matrix, in kg m2, from its six numbers."""

    def __init__(
        self, Ixx: float = 0, Iyy: float = 0, Izz: float = 0, Ixy: float = 0, Ixz: float = 0, Iyz: float = 0
    ) -> None:
        self.data = [float(value) for value in (Ixx, Ixy, Ixz, Ixy, Iyy, Iyz, Ixz, Iyz, Izz)]

    @staticmethod
    def Zero() -> RotationalInertia:
        """Return a zero inertia."""
        return RotationalInertia()

    @staticmethod
    def _of(data: list[float]) -> RotationalInertia:
        """From the nine numbers of the matrix, by row."""
        made = RotationalInertia()
        made.data = list(data)
        return made

    def __getitem__(self, index: int) -> float:
        return self.data[self._checked(index)]

    def __setitem__(self, index: int, value: float) -> None:
        self.data[self._checked(index)] = float(value)

    def _checked(self, index: int) -> int:
        if not 0 <= index <= 8:
            raise IndexError("RotationalInertia index out of range")
        return index

    def __add__(self, other: RotationalInertia) -> RotationalInertia:
        return self._of([one + two for one, two in zip(self.data, other.data, strict=True)])

    def __mul__(self, vector: Vector) -> Vector:
        return Vector(Rotation(*self.data) * vector)

    def __rmul__(self, factor: float) -> RotationalInertia:
        return self._of([value * factor for value in self.data])


class RigidBodyInertia:
    """The inertia of a body.

    Args:
        m: mass, in kg.
        oc: centre of mass, in m.
        Ic: rotational inertia about the centre of mass.
    """

    def __init__(self, m: float = 0, oc: Vector | None = None, Ic: RotationalInertia | None = None) -> None:
        center = Vector() if oc is None else oc
        self.m = float(m)
        self.h = center * self.m
        self.I = (RotationalInertia() if Ic is None else Ic) + self.m * _of_point(center, center)

    @staticmethod
    def Zero() -> RigidBodyInertia:
        """Return a zero inertia."""
        return RigidBodyInertia()

    @staticmethod
    def _of(m: float, h: Vector, inertia: RotationalInertia) -> RigidBodyInertia:
        made = RigidBodyInertia()
        made.m, made.h, made.I = m, h, inertia
        return made

    def getMass(self) -> float:
        """Mass, in kg."""
        return self.m

    def getCOG(self) -> Vector:
        """Return the centre of mass in m, or the origin if there is no mass."""
        return self.h / self.m if self.m else Vector()

    def getRotationalInertia(self) -> RotationalInertia:
        """Rotational inertia about the origin."""
        return self.I

    def RefPoint(self, p: Vector) -> RigidBodyInertia:
        """Return the same inertia with the origin at another point."""
        moved = self.h - p * self.m
        inertia = self.I + -1.0 * _of_point(p, self.h) + -1.0 * _of_point(moved, p)
        return self._of(self.m, moved, inertia)

    def __add__(self, other: RigidBodyInertia) -> RigidBodyInertia:
        return self._of(self.m + other.m, self.h + other.h, self.I + other.I)

    def __mul__(self, twist: Twist) -> Wrench:
        """Return the momentum of a motion."""
        return Wrench(twist.vel * self.m - self.h * twist.rot, self.I * twist.rot + self.h * twist.vel)

    def __rmul__(self, other: Any) -> RigidBodyInertia:
        if isinstance(other, Rotation):
            columns = [other * (self.I * other.Inverse(axis)) for axis in _AXES]
            data = [column[row] for row in range(3) for column in columns]
            return self._of(self.m, other * self.h, RotationalInertia._of(data))
        if isinstance(other, Frame):
            return self.__rmul__(other.M).RefPoint(-other.p)
        return self._of(self.m * other, self.h * other, other * self.I)


_AXES = (Vector(1, 0, 0), Vector(0, 1, 0), Vector(0, 0, 1))


def _of_point(a: Vector, b: Vector) -> RotationalInertia:
    """Return (a.b) 1 - b aT, the inertia of a point mass, where b is the point times the mass."""
    product = scalar_product(a, b)
    return RotationalInertia._of([(product if i == j else 0.0) - b[i] * a[j] for i in range(3) for j in range(3)])
