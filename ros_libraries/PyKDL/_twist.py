"""`Twist` and `Wrench`: velocity with angular velocity, force with torque; six numbers each."""

from __future__ import annotations

from typing import Any, ClassVar, Self

from ._vector import EPSILON, Vector, columns, near


class _Pair:
    """Two vectors that are added and scaled together."""

    _names: ClassVar[tuple[str, str]]

    def __init__(self, *args: Any) -> None:
        if len(args) == 1:
            args = args[0]._vectors()
        elif len(args) not in (0, 2):
            raise TypeError(f"{type(self).__name__}() takes nothing, two Vectors or a {type(self).__name__}")
        for name, vector in zip(self._names, args or (Vector(), Vector()), strict=True):
            setattr(self, name, Vector(vector))

    def _vectors(self) -> tuple[Vector, Vector]:
        first, second = self._names
        return getattr(self, first), getattr(self, second)

    def _numbers(self) -> list[float]:
        first, second = self._vectors()
        return [*first.v, *second.v]

    def _place(self, index: int) -> tuple[Vector, int]:
        if not 0 <= index <= 5:
            raise IndexError(f"{type(self).__name__} index out of range")
        return self._vectors()[index // 3], index % 3

    def __getitem__(self, index: int) -> float:
        vector, at = self._place(index)
        return vector[at]

    def __setitem__(self, index: int, value: float) -> None:
        vector, at = self._place(index)
        vector[at] = value

    def __repr__(self) -> str:
        return f"[{columns(self._numbers())}]"

    def __copy__(self) -> Self:
        return type(self)(self)

    def __deepcopy__(self, memo: Any) -> Self:
        return type(self)(self)

    def __add__(self, other: Any) -> Any:
        if type(other) is not type(self):
            return NotImplemented
        return type(self)(*(one + two for one, two in zip(self._vectors(), other._vectors(), strict=True)))

    def __sub__(self, other: Any) -> Any:
        return self + -other if type(other) is type(self) else NotImplemented

    def __iadd__(self, other: Any) -> Self:
        return self._become(self + other)

    def __isub__(self, other: Any) -> Self:
        return self._become(self - other)

    def _become(self, other: Any) -> Self:
        for name in self._names:
            setattr(self, name, getattr(other, name))
        return self

    def __mul__(self, other: Any) -> Any:
        if not isinstance(other, (int, float)):
            return NotImplemented
        return type(self)(*(vector * other for vector in self._vectors()))

    __rmul__ = __mul__

    def __truediv__(self, other: float) -> Self:
        return type(self)(*(vector / other for vector in self._vectors()))

    def __neg__(self) -> Self:
        return type(self)(*(-vector for vector in self._vectors()))

    def __eq__(self, other: object) -> bool:
        return self._equals(other) if isinstance(other, type(self)) else NotImplemented

    def _equals(self, other: _Pair, eps: float = EPSILON) -> bool:
        """Return whether no number differs by `eps` or more."""
        return near(self._numbers(), other._numbers(), eps)

    def __hash__(self) -> int:
        return hash(tuple(self._numbers()))

    def ReverseSign(self) -> None:
        """Turn both vectors round, in place."""
        self._become(-self)

    @classmethod
    def Zero(cls) -> Self:
        """Return all zeros."""
        return cls()


class Twist(_Pair):
    """`vel`, a velocity, and `rot`, an angular velocity: `Twist()`, `Twist(vel, rot)` or a copy of another one."""

    _names = ("vel", "rot")
    vel: Vector
    rot: Vector

    def RefPoint(self, base: Vector) -> Twist:
        """Return the same motion seen at a point that lies at `base` from the present one."""
        return Twist(self.vel + self.rot * base, self.rot)


class Wrench(_Pair):
    """`force` and `torque`: `Wrench()`, `Wrench(force, torque)` or a copy of another one."""

    _names = ("force", "torque")
    force: Vector
    torque: Vector

    def RefPoint(self, base: Vector) -> Wrench:
        """Return the same load seen at a point that lies at `base` from the present one."""
        return Wrench(self.force, self.torque + self.force * base)
