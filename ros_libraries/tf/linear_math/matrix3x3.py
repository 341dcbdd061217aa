"""Matrix3x3.h: rotations as matrices. Imports tf.linear_math."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from math import asin, atan2, cos, pi, sin, sqrt
from typing import overload

from tf.linear_math.jacobi import diagonalize
from tf.linear_math.quaternion import Quaternion
from tf.linear_math.vector3 import Vector3

Angles = tuple[float, float, float]


class Matrix3x3:
    """A matrix from nine numbers row by row, or from a quaternion; the identity without arguments.

    An index gives a row.
    """

    __slots__ = ("m_el",)
    __hash__ = None  # type: ignore[assignment]  # it can change

    @overload
    def __init__(self) -> None: ...
    @overload
    def __init__(self, rotation: Quaternion, /) -> None: ...
    @overload
    def __init__(self, *cells: float) -> None: ...
    def __init__(self, *values: Quaternion | float) -> None:
        self.m_el = [Vector3(1.0, 0.0, 0.0), Vector3(0.0, 1.0, 0.0), Vector3(0.0, 0.0, 1.0)]
        if len(values) == 1 and isinstance(values[0], Quaternion):
            self.setRotation(values[0])
        elif values:
            self.setValue(*(value for value in values if not isinstance(value, Quaternion)))

    def __getitem__(self, row: int) -> Vector3:
        return self.m_el[row]

    def __iter__(self) -> Iterator[Vector3]:
        return iter(self.m_el)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Matrix3x3) and self.m_el == other.m_el

    def __repr__(self) -> str:
        return f"Matrix3x3({', '.join(repr(cell) for row in self for cell in row)})"

    # -- parts -------------------------------------------------------------------------------------------------------

    def getRow(self, i: int) -> Vector3:
        """Return a row. Changing it changes the matrix."""
        return self.m_el[i]

    def getColumn(self, i: int) -> Vector3:
        """Return a copy of a column."""
        return Vector3(*(row[i] for row in self))

    def setValue(self, *cells: float) -> None:
        """Set all nine numbers, row by row."""
        for row, at in zip(self.m_el, (0, 3, 6), strict=True):
            row.setValue(*cells[at : at + 3])

    def setIdentity(self) -> None:
        """Become the identity."""
        self.setValue(1.0, 0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0)

    @staticmethod
    def getIdentity() -> Matrix3x3:
        """Return the identity."""
        return Matrix3x3()

    def setFromOpenGLSubMatrix(self, m: Sequence[float]) -> None:
        """Take the upper left 3x3 cells of a 4x4 matrix that is stored column by column."""
        self.setValue(*(m[column * 4 + row] for row in range(3) for column in range(3)))

    def getOpenGLSubMatrix(self) -> list[float]:
        """Return three columns of four numbers, the last one 0."""
        return [cell for column in range(3) for cell in (*self.getColumn(column), 0.0)]

    # -- rotations ---------------------------------------------------------------------------------------------------

    def setRotation(self, q: Quaternion) -> None:
        """Become the rotation of a quaternion of any length."""
        x, y, z, w = q
        s = 2.0 / q.length2()
        xs, ys, zs = x * s, y * s, z * s
        wx, wy, wz = w * xs, w * ys, w * zs
        xx, xy, xz = x * xs, x * ys, x * zs
        yy, yz, zz = y * ys, y * zs, z * zs
        first, second = (1.0 - (yy + zz), xy - wz, xz + wy), (xy + wz, 1.0 - (xx + zz), yz - wx)
        self.setValue(*first, *second, xz - wy, yz + wx, 1.0 - (xx + yy))

    def getRotation(self) -> Quaternion:
        """Return the quaternion of this rotation."""
        m = self.m_el
        trace = m[0][0] + m[1][1] + m[2][2]
        found = Quaternion()
        if trace > 0.0:
            s = sqrt(trace + 1.0)
            f = 0.5 / s
            found.setValue((m[2][1] - m[1][2]) * f, (m[0][2] - m[2][0]) * f, (m[1][0] - m[0][1]) * f, s * 0.5)
            return found
        i = max(range(3), key=lambda axis: m[axis][axis])
        j, k = (i + 1) % 3, (i + 2) % 3
        s = sqrt(m[i][i] - m[j][j] - m[k][k] + 1.0)
        f = 0.5 / s
        found[i], found[j], found[k] = s * 0.5, (m[j][i] + m[i][j]) * f, (m[k][i] + m[i][k]) * f
        found.setW((m[k][j] - m[j][k]) * f)
        return found

    def setEulerYPR(self, eulerZ: float, eulerY: float, eulerX: float) -> None:
        """Become a rotation by angles in rad about Z, then the new Y, then the new X."""
        ci, cj, ch = cos(eulerX), cos(eulerY), cos(eulerZ)
        si, sj, sh = sin(eulerX), sin(eulerY), sin(eulerZ)
        cc, cs, sc, ss = ci * ch, ci * sh, si * ch, si * sh
        first, second = (cj * ch, sj * sc - cs, sj * cc + ss), (cj * sh, sj * ss + cc, sj * cs - sc)
        self.setValue(*first, *second, -sj, cj * si, cj * ci)

    setEulerZYX = setEulerYPR

    def setRPY(self, roll: float, pitch: float, yaw: float) -> None:
        """Become a rotation by angles in rad about the fixed axes X, Y and Z."""
        self.setEulerYPR(yaw, pitch, roll)

    def getEulerYPR(self, solution_number: int = 1) -> Angles:
        """Return yaw, pitch and roll of this rotation in rad. There are two solutions."""
        m = self.m_el
        sine = m[2][0]
        if abs(sine) >= 1.0:  # gimbal lock: only the difference of the other two angles counts
            sign = 1.0 if sine < 0 else -1.0
            return 0.0, sign * pi / 2.0, atan2(sign * m[0][1], sign * m[0][2])
        pitch = -asin(sine)
        if solution_number != 1:
            pitch = pi - pitch
        c = cos(pitch)
        return atan2(m[1][0] / c, m[0][0] / c), pitch, atan2(m[2][1] / c, m[2][2] / c)

    getEulerZYX = getEulerYPR

    def getRPY(self, solution_number: int = 1) -> Angles:
        """Return roll, pitch and yaw of this rotation in rad. There are two solutions."""
        yaw, pitch, roll = self.getEulerYPR(solution_number)
        return roll, pitch, yaw

    # -- products ----------------------------------------------------------------------------------------------------

    @overload
    def __mul__(self, other: Matrix3x3) -> Matrix3x3: ...
    @overload
    def __mul__(self, other: Vector3) -> Vector3: ...
    def __mul__(self, other: Matrix3x3 | Vector3) -> Matrix3x3 | Vector3:
        if isinstance(other, Vector3):
            return Vector3(*(row.dot(other) for row in self))
        return Matrix3x3(*(cell for row in self for cell in row * other))

    def __rmul__(self, other: Vector3) -> Vector3:
        return Vector3(self.tdotx(other), self.tdoty(other), self.tdotz(other))

    def __imul__(self, other: Matrix3x3) -> Matrix3x3:  # type: ignore[misc]  # a product with a vector is no matrix
        self.m_el = (self * other).m_el
        return self

    def tdotx(self, v: Vector3) -> float:
        """Return the scalar product of the first column and a vector."""
        return self.getColumn(0).dot(v)

    def tdoty(self, v: Vector3) -> float:
        """Return the scalar product of the second column and a vector."""
        return self.getColumn(1).dot(v)

    def tdotz(self, v: Vector3) -> float:
        """Return the scalar product of the third column and a vector."""
        return self.getColumn(2).dot(v)

    def transposeTimes(self, m: Matrix3x3) -> Matrix3x3:
        """Return this matrix, transposed, times another."""
        return self.transpose() * m

    def timesTranspose(self, m: Matrix3x3) -> Matrix3x3:
        """Return this matrix times another, transposed."""
        return self * m.transpose()

    def scaled(self, s: Vector3) -> Matrix3x3:
        """Return this matrix with its columns scaled by the elements of a vector."""
        return Matrix3x3(*(cell for row in self for cell in row * s))

    # -- derived matrices --------------------------------------------------------------------------------------------

    def transpose(self) -> Matrix3x3:
        """Return the transposed matrix."""
        return Matrix3x3(*(row[at] for at in range(3) for row in self))

    def absolute(self) -> Matrix3x3:
        """Return the absolute values."""
        return Matrix3x3(*(abs(cell) for row in self for cell in row))

    def cofac(self, r1: int, c1: int, r2: int, c2: int) -> float:
        """Return the determinant of two rows and two columns."""
        m = self.m_el
        return m[r1][c1] * m[r2][c2] - m[r1][c2] * m[r2][c1]

    def determinant(self) -> float:
        """Return the determinant."""
        return self[0].triple(self[1], self[2])

    def adjoint(self) -> Matrix3x3:
        """Return the adjoint: the inverse times the determinant."""
        others = ((1, 2), (2, 0), (0, 1))
        return Matrix3x3(*(self.cofac(b, c, d, e) for c, e in others for b, d in others))

    def inverse(self) -> Matrix3x3:
        """Return the inverse.

        Raises:
            ZeroDivisionError: the matrix is singular.
        """
        s = 1.0 / self.determinant()
        return Matrix3x3(*(cell * s for row in self.adjoint() for cell in row))

    def diagonalize(self, rot: Matrix3x3, threshold: float, maxSteps: int) -> None:
        """Diagonalize this matrix by Jacobi's method. The matrix must be symmetric.

        Args:
            rot: becomes the rotation R for which the old matrix is R * new * transposed R.
            threshold: maximum size of the remaining elements off the diagonal, as a fraction of the diagonal's sum.
            maxSteps: maximum number of rotations.
        """
        rot.setIdentity()
        diagonalize(self.m_el, rot.m_el, threshold, maxSteps)
