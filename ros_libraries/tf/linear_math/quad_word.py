"""QuadWord.h: four numbers, the storage of Quaternion and Vector3. Imports tf.linear_math.min_max."""

from __future__ import annotations

from collections.abc import Iterator

from tf.linear_math.min_max import tfSetMax, tfSetMin


class QuadWord:
    """Four numbers, also by index.

    Args:
        x, y, z, w: the numbers.
    """

    __slots__ = ("m_floats",)
    __hash__ = None  # type: ignore[assignment]  # it can change

    def __init__(self, x: float = 0.0, y: float = 0.0, z: float = 0.0, w: float = 0.0) -> None:
        self.m_floats = [float(x), float(y), float(z), float(w)]

    def x(self) -> float:
        """Return the first number."""
        return self.m_floats[0]

    def y(self) -> float:
        """Return the second number."""
        return self.m_floats[1]

    def z(self) -> float:
        """Return the third number."""
        return self.m_floats[2]

    def w(self) -> float:
        """Return the fourth number."""
        return self.m_floats[3]

    getX, getY, getZ, getW = x, y, z, w

    def setX(self, x: float) -> None:
        """Set the first number."""
        self.m_floats[0] = float(x)

    def setY(self, y: float) -> None:
        """Set the second number."""
        self.m_floats[1] = float(y)

    def setZ(self, z: float) -> None:
        """Set the third number."""
        self.m_floats[2] = float(z)

    def setW(self, w: float) -> None:
        """Set the fourth number."""
        self.m_floats[3] = float(w)

    def setValue(self, x: float, y: float, z: float, w: float = 0.0) -> None:
        """Set all numbers."""
        self.m_floats[:] = float(x), float(y), float(z), float(w)

    def setMax(self, other: QuadWord) -> None:
        """Take each number of another one that is larger."""
        self.m_floats[:] = map(tfSetMax, self.m_floats, other.m_floats)

    def setMin(self, other: QuadWord) -> None:
        """Take each number of another one that is smaller."""
        self.m_floats[:] = map(tfSetMin, self.m_floats, other.m_floats)

    def __getitem__(self, index: int) -> float:
        return self.m_floats[index]

    def __setitem__(self, index: int, value: float) -> None:
        self.m_floats[index] = float(value)

    def __iter__(self) -> Iterator[float]:
        return iter(self.m_floats)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, QuadWord) and self.m_floats == other.m_floats

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(map(repr, self))})"
