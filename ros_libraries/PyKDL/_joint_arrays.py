"""`JntArray` and `Jacobian`: a number, and a column of six, for each joint of a chain."""

from __future__ import annotations

from typing import Any

from ._frame import Frame
from ._rotation import Rotation
from ._twist import Twist
from ._vector import Vector, columns


class JntArray:
    """Positions, velocities or torques of joints: `JntArray(size)` makes zeros, `JntArray(other)` a copy."""

    def __init__(self, size: Any = 0) -> None:
        self.q: list[float] = list(size.q) if isinstance(size, JntArray) else [0.0] * size

    def rows(self) -> int:
        """Return how many joints."""
        return len(self.q)

    def columns(self) -> int:
        """One."""
        return 1

    def resize(self, size: int) -> None:
        """Drop values at the end, or add zeros."""
        self.q = (self.q + [0.0] * size)[:size]

    def __getitem__(self, index: int) -> float:
        return self.q[self._checked(index)]

    def __setitem__(self, index: int, value: float) -> None:
        self.q[self._checked(index)] = float(value)

    def _checked(self, index: int) -> int:
        if not 0 <= index < len(self.q):
            raise IndexError("JntArray index out of range")
        return index

    def __repr__(self) -> str:
        return "\n".join(f"{value:.6g}" for value in self.q)

    def __eq__(self, other: object) -> bool:
        return self.q == other.q if isinstance(other, JntArray) else NotImplemented

    __hash__ = None  # type: ignore[assignment]  # its values change


class Jacobian:
    """The twist that each joint makes at a speed of 1: `Jacobian(nr_columns)` or a copy of another one."""

    def __init__(self, nr_columns: Any = 0) -> None:
        given = nr_columns.twists if isinstance(nr_columns, Jacobian) else [Twist()] * nr_columns
        self.twists: list[Twist] = [Twist(each) for each in given]

    def rows(self) -> int:
        """Six."""
        return 6

    def columns(self) -> int:
        """Return how many joints."""
        return len(self.twists)

    def resize(self, nr_columns: int) -> None:
        """Drop columns at the end, or add zeros."""
        self.twists = (self.twists + [Twist() for _ in range(nr_columns)])[:nr_columns]

    def getColumn(self, index: int) -> Twist:
        """Return the twist of a joint."""
        return Twist(self.twists[index])

    def setColumn(self, index: int, t: Twist) -> None:
        """Set the twist of a joint."""
        self.twists[index] = Twist(t)

    def changeRefPoint(self, base: Vector) -> None:
        """See all twists at another point, in place."""
        self.twists = [each.RefPoint(base) for each in self.twists]

    def changeBase(self, rot: Rotation) -> None:
        """Turn all twists, in place."""
        self.twists = [rot * each for each in self.twists]

    def changeRefFrame(self, frame: Frame) -> None:
        """See all twists from another frame, in place."""
        self.twists = [frame * each for each in self.twists]

    def __getitem__(self, index: tuple[int, int]) -> float:
        row, column = self._checked(index)
        return self.twists[column][row]

    def __setitem__(self, index: tuple[int, int], value: float) -> None:
        row, column = self._checked(index)
        self.twists[column][row] = value

    def _checked(self, index: tuple[int, int]) -> tuple[int, int]:
        row, column = index
        if not (0 <= row <= 5 and 0 <= column < len(self.twists)):
            raise IndexError("Jacobian index out of range")
        return row, column

    def __repr__(self) -> str:
        return "[" + "\n".join(columns(each[row] for each in self.twists) for row in range(6)) + "]"
