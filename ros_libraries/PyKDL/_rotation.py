"""`Rotation`: a rotation as a 3x3 matrix."""

from __future__ import annotations

import math
from typing import Any

from ._twist import Twist, Wrench
from ._vector import EPSILON, Vector, columns, near

_UPRIGHT = 1e-12  # distance from the poles below which angles are not unique


class Rotation:
    """A rotation from nine numbers by row, from three column vectors, or from a copy; `Rotation()` is the identity."""

    def __init__(self, *args: Any) -> None:
        if len(args) == 1:
            args = tuple(args[0].m)
        elif len(args) == 3:
            args = tuple(vector[row] for row in range(3) for vector in args)
        elif len(args) not in (0, 9):
            raise TypeError("Rotation() takes nothing, nine numbers, three Vectors or a Rotation")
        self.m: list[float] = [float(value) for value in args or (1, 0, 0, 0, 1, 0, 0, 0, 1)]

    # -- made from -----------------------------------------------------------------------------------------------------

    @staticmethod
    def Identity() -> Rotation:
        """Return no rotation."""
        return Rotation()

    @staticmethod
    def RotX(angle: float) -> Rotation:
        """About x, in rad."""
        c, s = math.cos(angle), math.sin(angle)
        return Rotation(1, 0, 0, 0, c, -s, 0, s, c)

    @staticmethod
    def RotY(angle: float) -> Rotation:
        """About y, in rad."""
        c, s = math.cos(angle), math.sin(angle)
        return Rotation(c, 0, s, 0, 1, 0, -s, 0, c)

    @staticmethod
    def RotZ(angle: float) -> Rotation:
        """About z, in rad."""
        c, s = math.cos(angle), math.sin(angle)
        return Rotation(c, -s, 0, s, c, 0, 0, 0, 1)

    @staticmethod
    def Rot(rotvec: Vector, angle: float) -> Rotation:
        """About an axis of any length, in rad."""
        axis = Vector(rotvec)
        axis.Normalize()
        return Rotation.Rot2(axis, angle)

    @staticmethod
    def Rot2(rotvec: Vector, angle: float) -> Rotation:
        """About an axis of length 1, in rad."""
        c, s = math.cos(angle), math.sin(angle)
        x, y, z = rotvec.v
        t = 1 - c
        return Rotation(
            t * x * x + c, t * x * y - z * s, t * x * z + y * s,
            t * x * y + z * s, t * y * y + c, t * y * z - x * s,
            t * x * z - y * s, t * y * z + x * s, t * z * z + c,
        )  # fmt: skip

    @staticmethod
    def RPY(roll: float, pitch: float, yaw: float) -> Rotation:
        """About fixed x, then y, then z, in rad."""
        return Rotation(Rotation.RotZ(yaw) * Rotation.RotY(pitch) * Rotation.RotX(roll))

    @staticmethod
    def EulerZYX(alpha: float, beta: float, gamma: float) -> Rotation:
        """About z, then the new y, then the new x, in rad."""
        return Rotation.RPY(gamma, beta, alpha)

    @staticmethod
    def EulerZYZ(alpha: float, beta: float, gamma: float) -> Rotation:
        """About z, then the new y, then the new z, in rad."""
        return Rotation(Rotation.RotZ(alpha) * Rotation.RotY(beta) * Rotation.RotZ(gamma))

    @staticmethod
    def Quaternion(x: float, y: float, z: float, w: float) -> Rotation:
        """From a quaternion of length 1."""
        xx, yy, zz, ww = x * x, y * y, z * z, w * w
        return Rotation(
            ww + xx - yy - zz, 2 * (x * y - w * z), 2 * (x * z + w * y),
            2 * (x * y + w * z), ww - xx + yy - zz, 2 * (y * z - w * x),
            2 * (x * z - w * y), 2 * (y * z + w * x), ww - xx - yy + zz,
        )  # fmt: skip

    # -- read as -------------------------------------------------------------------------------------------------------

    def GetQuaternion(self) -> tuple[float, float, float, float]:
        """(x, y, z, w)."""
        m = self.m
        trace = m[0] + m[4] + m[8]
        if trace > _UPRIGHT:
            s = 0.5 / math.sqrt(trace + 1)
            return (m[7] - m[5]) * s, (m[2] - m[6]) * s, (m[3] - m[1]) * s, 0.25 / s
        if m[0] > m[4] and m[0] > m[8]:
            s = 2 * math.sqrt(1 + m[0] - m[4] - m[8])
            return 0.25 * s, (m[1] + m[3]) / s, (m[2] + m[6]) / s, (m[7] - m[5]) / s
        if m[4] > m[8]:
            s = 2 * math.sqrt(1 + m[4] - m[0] - m[8])
            return (m[1] + m[3]) / s, 0.25 * s, (m[5] + m[7]) / s, (m[2] - m[6]) / s
        s = 2 * math.sqrt(1 + m[8] - m[0] - m[4])
        return (m[2] + m[6]) / s, (m[5] + m[7]) / s, 0.25 * s, (m[3] - m[1]) / s

    def GetRPY(self) -> tuple[float, float, float]:
        """Return (roll, pitch, yaw) in rad. At a pole, the roll is 0."""
        m = self.m
        pitch = math.atan2(-m[6], math.hypot(m[0], m[3]))
        if abs(pitch) > math.pi / 2 - _UPRIGHT:
            return 0.0, pitch, math.atan2(-m[1], m[4])
        return math.atan2(m[7], m[8]), pitch, math.atan2(m[3], m[0])

    def GetEulerZYX(self) -> tuple[float, float, float]:
        """(alpha, beta, gamma) in rad, see `EulerZYX`."""
        roll, pitch, yaw = self.GetRPY()
        return yaw, pitch, roll

    def GetEulerZYZ(self) -> tuple[float, float, float]:
        """Return (alpha, beta, gamma) in rad, see `EulerZYZ`. At a pole, gamma is 0."""
        m = self.m
        if abs(m[8]) >= 1 - _UPRIGHT:
            return (math.atan2(m[3], m[0]), 0.0, 0.0) if m[8] > 0 else (math.atan2(-m[3], -m[0]), math.pi, 0.0)
        return math.atan2(m[5], m[2]), math.atan2(math.hypot(m[6], m[7]), m[8]), math.atan2(m[7], -m[6])

    def GetRotAngle(self, eps: float = EPSILON) -> tuple[float, Vector]:
        """Return the angle in rad, 0 to pi, and the axis. Without rotation the axis is (0, 0, 1)."""
        m = self.m
        axis = Vector(m[7] - m[5], m[2] - m[6], m[3] - m[1])
        if any(abs(value) >= eps for value in axis.v):
            length = axis.Norm(0)
            return math.atan2(length / 2, (m[0] + m[4] + m[8] - 1) / 2), axis / length
        if near(m, Rotation().m, 10 * eps):
            return 0.0, Vector(0, 0, 1)
        return math.pi, self._axis_of_half_turn()

    def _axis_of_half_turn(self) -> Vector:
        """Return the axis of a half turn.

        Its matrix is symmetric: (matrix + 1) / 2 is the product of the axis with itself.
        """
        m = self.m
        squares = [(m[0] + 1) / 2, (m[4] + 1) / 2, (m[8] + 1) / 2]
        at = max((2, 1, 0), key=squares.__getitem__)
        largest = math.sqrt(squares[at])
        return Vector(*(largest if i == at else (m[3 * at + i] + m[3 * i + at]) / (4 * largest) for i in range(3)))

    def GetRot(self) -> Vector:
        """Return the axis, with the angle in rad as its length."""
        angle, axis = self.GetRotAngle()
        return Vector(axis * angle)

    # -- used as -------------------------------------------------------------------------------------------------------

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, Rotation):
            return Rotation(self * other.UnitX(), self * other.UnitY(), self * other.UnitZ())
        if isinstance(other, Vector):
            x, y, z = other.v
            return Vector(*(a * x + b * y + c * z for a, b, c in zip(*[iter(self.m)] * 3, strict=True)))
        if isinstance(other, (Twist, Wrench)):
            return type(other)(*(self * vector for vector in other._vectors()))
        return NotImplemented

    def Inverse(self, arg: Any = None) -> Any:
        """Return the inverse, or the inverse applied to a Vector, Twist or Wrench."""
        m = self.m
        inverse = Rotation(m[0], m[3], m[6], m[1], m[4], m[7], m[2], m[5], m[8])
        return inverse if arg is None else inverse * arg

    def SetInverse(self) -> None:
        """Invert it in place."""
        self.m = self.Inverse().m

    def DoRotX(self, angle: float) -> None:
        """Turn it about its x, in place."""
        self.m = (self * Rotation.RotX(angle)).m

    def DoRotY(self, angle: float) -> None:
        """Turn it about its y, in place."""
        self.m = (self * Rotation.RotY(angle)).m

    def DoRotZ(self, angle: float) -> None:
        """Turn it about its z, in place."""
        self.m = (self * Rotation.RotZ(angle)).m

    def UnitX(self, vec: Vector | None = None) -> Vector | None:
        """Return the first column, or set it if a vector is given."""
        return self._column(0, vec)

    def UnitY(self, vec: Vector | None = None) -> Vector | None:
        """Return the second column, or set it if a vector is given."""
        return self._column(1, vec)

    def UnitZ(self, vec: Vector | None = None) -> Vector | None:
        """Return the third column, or set it if a vector is given."""
        return self._column(2, vec)

    def _column(self, index: int, vec: Vector | None) -> Vector | None:
        if vec is None:
            return Vector(*self.m[index::3])
        self.m[index::3] = vec.v
        return None

    def __getitem__(self, index: tuple[int, int]) -> float:
        return self.m[_place(index)]

    def __setitem__(self, index: tuple[int, int], value: float) -> None:
        self.m[_place(index)] = float(value)

    def __repr__(self) -> str:
        return "[" + ";\n ".join(columns(self.m[at : at + 3]) for at in (0, 3, 6)) + "]"

    def __copy__(self) -> Rotation:
        return Rotation(self)

    def __deepcopy__(self, memo: Any) -> Rotation:
        return Rotation(self)

    def __eq__(self, other: object) -> bool:
        return near(self.m, other.m) if isinstance(other, Rotation) else NotImplemented

    def __hash__(self) -> int:
        return hash(tuple(self.m))


def _place(index: tuple[int, int]) -> int:
    row, column = index
    if not (0 <= row <= 2 and 0 <= column <= 2):
        raise IndexError("Rotation index out of range")
    return 3 * row + column
