"""Jacobi's method, for `Matrix3x3.diagonalize`. Imports tf.linear_math."""

from __future__ import annotations

from math import sqrt

from tf.linear_math.scalar import TFSIMD_EPSILON
from tf.linear_math.vector3 import Vector3

Rows = list[Vector3]
_PAIRS = ((0, 1, 2), (0, 2, 1), (1, 2, 0))  # an element off the diagonal, and the remaining index


def diagonalize(rows: Rows, turned: Rows, threshold: float, steps: int) -> None:
    """Diagonalize a symmetric matrix in place, and apply the rotations to `turned`."""
    while steps > 0:
        p, q, r = max(_PAIRS, key=lambda pair: abs(rows[pair[0]][pair[1]]))
        size = abs(rows[p][q])
        small = threshold * sum(abs(rows[at][at]) for at in range(3))
        if size <= small:
            if size <= TFSIMD_EPSILON * small:
                return
            steps = 1
        _turn(rows, turned, p, q, r)
        steps -= 1


def _turn(rows: Rows, turned: Rows, p: int, q: int, r: int) -> None:
    """One rotation, which makes the element (p, q) vanish."""
    element = rows[p][q]
    tangent = _tangent((rows[q][q] - rows[p][p]) / (2 * element))
    cosine = 1 / sqrt(1 + tangent * tangent)
    sine = cosine * tangent
    rows[p][q] = rows[q][p] = 0.0
    rows[p][p] -= tangent * element
    rows[q][q] += tangent * element
    rp, rq = rows[r][p], rows[r][q]
    rows[r][p] = rows[p][r] = cosine * rp - sine * rq
    rows[r][q] = rows[q][r] = cosine * rq + sine * rp
    for row in turned:
        row[p], row[q] = cosine * row[p] - sine * row[q], cosine * row[q] + sine * row[p]


def _tangent(theta: float) -> float:
    """Return the tangent of the angle to turn by. For a matrix that is almost diagonal, use a series."""
    square = theta * theta
    if square * square < 10 / TFSIMD_EPSILON:
        root = sqrt(1 + square)
        return 1 / (theta + root) if theta >= 0 else 1 / (theta - root)
    return 1 / (theta * (2 + 0.5 / square))
