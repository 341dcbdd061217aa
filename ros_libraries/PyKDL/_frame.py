"""`Frame`: a pose, which consists of a rotation and a position."""

from __future__ import annotations

from typing import Any

from ._rotation import Rotation
from ._twist import Twist, Wrench
from ._vector import EPSILON, Vector


class Frame:
    """A pose with the rotation `M` and the position `p`: `Frame()`, `Frame(M, p)`, one of them, or a copy."""

    def __init__(self, *args: Any) -> None:
        if len(args) == 1:
            only = args[0]
            args = (only.M, only.p) if isinstance(only, Frame) else _completed(only)
        elif len(args) not in (0, 2):
            raise TypeError("Frame() takes a Rotation and a Vector, one of them, a Frame or nothing")
        rotation, position = args or (Rotation(), Vector())
        self.M: Rotation = Rotation(rotation)
        self.p: Vector = Vector(position)

    @staticmethod
    def Identity() -> Frame:
        """Return the identity frame."""
        return Frame()

    @staticmethod
    def DH(a: float, alpha: float, d: float, theta: float) -> Frame:
        """From the parameters of Denavit and Hartenberg, in m and rad."""
        return Frame(Frame(Rotation.RotZ(theta), Vector(0, 0, d)) * Frame(Rotation.RotX(alpha), Vector(a, 0, 0)))

    @staticmethod
    def DH_Craig1989(a: float, alpha: float, d: float, theta: float) -> Frame:
        """From the parameters of Denavit and Hartenberg as Craig has them, in m and rad."""
        return Frame(Frame(Rotation.RotX(alpha), Vector(a, 0, 0)) * Frame(Rotation.RotZ(theta), Vector(0, 0, d)))

    def __mul__(self, other: Any) -> Any:
        if isinstance(other, Frame):
            return Frame(self.M * other.M, self * other.p)
        if isinstance(other, Vector):
            return self.M * other + self.p
        if isinstance(other, Twist):
            rot = self.M * other.rot
            return Twist(self.M * other.vel + self.p * rot, rot)
        if isinstance(other, Wrench):
            force = self.M * other.force
            return Wrench(force, self.M * other.torque + self.p * force)
        return NotImplemented

    def Inverse(self, arg: Any = None) -> Any:
        """Return the inverse, or the inverse applied to a Vector, Twist or Wrench."""
        inverse = Frame(self.M.Inverse(), -self.M.Inverse(self.p))
        return inverse if arg is None else inverse * arg

    def Integrate(self, twist: Twist, sample_frequency: float) -> None:
        """Move it in place for one sample.

        Args:
            twist: its motion, in its own axes.
            sample_frequency: in Hz.
        """
        angle = twist.rot.Norm() / sample_frequency
        if angle < EPSILON:
            self.p = self.p + self.M * (twist.vel / sample_frequency)
            return
        moved = self * Frame(Rotation.Rot(twist.rot, angle), twist.vel / sample_frequency)
        self.M, self.p = moved.M, moved.p

    def __getitem__(self, index: tuple[int, int]) -> float:
        row, column = _checked(index)
        return self.p[row] if column == 3 else self.M[row, column]

    def __setitem__(self, index: tuple[int, int], value: float) -> None:
        row, column = _checked(index)
        if column == 3:
            self.p[row] = value
        else:
            self.M[row, column] = value

    def __repr__(self) -> str:
        return f"[{self.M!r}\n{self.p!r}]"

    def __copy__(self) -> Frame:
        return Frame(self)

    def __deepcopy__(self, memo: Any) -> Frame:
        return Frame(self)

    def __eq__(self, other: object) -> bool:
        return self.M == other.M and self.p == other.p if isinstance(other, Frame) else NotImplemented

    def __hash__(self) -> int:
        return hash((self.M, self.p))


def _completed(only: Any) -> tuple[Rotation, Vector]:
    if isinstance(only, Rotation):
        return only, Vector()
    if isinstance(only, Vector):
        return Rotation(), only
    raise TypeError(f"Frame() takes a Rotation, a Vector or a Frame, not {only!r}")


def _checked(index: tuple[int, int]) -> tuple[int, int]:
    row, column = index
    if not (0 <= row <= 2 and 0 <= column <= 3):
        raise IndexError("Frame index out of range")
    return row, column
