"""Euler angles, in any of 24 conventions. Imports NumPy.

A convention is a string: "s" for fixed axes or "r" for rotating axes, then three axes, as "sxyz". It can also be tf's
tuple (first axis, odd, repeated, turning). The first axis is 0 to 2, of the fixed axes. "odd": the second axis is not
the next in a circle. "repeated": the third axis is the first again. "turning": read it as rotating axes, backwards.
"""

from __future__ import annotations

import math
from itertools import product
from typing import Any

import numpy as np

from tf.transformations._quaternions import quaternion_matrix, quaternion_product
from tf.transformations._vectors import EPS

Axes = str | tuple[int, int, int, int]
Convention = tuple[int, int, int, int]


def _others(first: int, odd: int) -> tuple[int, int]:
    """Return the second axis, and the one that remains."""
    return (first + 1 + odd) % 3, (first + 2 - odd) % 3


def _name(convention: Convention) -> str:
    first, odd, repeated, turning = convention
    second, remaining = _others(first, odd)
    letters = "".join("xyz"[axis] for axis in (first, second, first if repeated else remaining))
    return f"r{letters[::-1]}" if turning else f"s{letters}"


CONVENTIONS: dict[str, Convention] = {_name(each): each for each in product((0, 1, 2), (0, 1), (0, 1), (0, 1))}


def _convention(axes: Axes) -> Convention:
    """Return a convention as a tuple.

    Raises:
        KeyError: the convention is unknown.
    """
    if isinstance(axes, str):
        return CONVENTIONS[axes.lower()]
    return CONVENTIONS[_name(axes)]


def euler_matrix(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Any:
    """Return the homogeneous matrix that turns by three angles in rad, about the axes of a convention."""
    return quaternion_matrix(quaternion_from_euler(ai, aj, ak, axes))


def euler_from_matrix(matrix: Any, axes: Axes = "sxyz") -> tuple[float, float, float]:
    """Return the angles in rad of a rotation matrix, about the axes of a convention. Other angles may also fit."""
    first, odd, repeated, turning = _convention(axes)
    i, (j, k) = first, _others(first, odd)
    m = np.asarray(matrix, dtype=np.float64)[:3, :3].tolist()
    if repeated:
        size = math.sqrt(m[i][j] * m[i][j] + m[i][k] * m[i][k])
        middle = math.atan2(size, m[i][i])
        outer = (m[i][j], m[i][k]), (m[j][i], -m[k][i])
    else:
        size = math.sqrt(m[i][i] * m[i][i] + m[j][i] * m[j][i])
        middle = math.atan2(-m[k][i], size)
        outer = (m[k][j], m[k][k]), (m[j][i], m[i][i])
    if size > EPS:
        start, end = math.atan2(*outer[0]), math.atan2(*outer[1])
    else:  # only the sum or difference of the outer angles counts
        start, end = math.atan2(-m[j][k], m[j][j]), 0.0
    if odd:
        start, middle, end = -start, -middle, -end
    return (end, middle, start) if turning else (start, middle, end)


def euler_from_quaternion(quaternion: Any, axes: Axes = "sxyz") -> tuple[float, float, float]:
    """Return the angles in rad of a rotation (x, y, z, w), about the axes of a convention."""
    return euler_from_matrix(quaternion_matrix(quaternion), axes)


def quaternion_from_euler(ai: float, aj: float, ak: float, axes: Axes = "sxyz") -> Any:
    """Return the quaternion (x, y, z, w) of turning by three angles in rad, about the axes of a convention."""
    name = _name(_convention(axes))
    turns = [_about(axis, angle) for axis, angle in zip(name[1:], (ai, aj, ak), strict=True)]
    first, second, third = turns[::-1] if name[0] == "r" else turns
    return np.array(quaternion_product(third, quaternion_product(second, first)))


def _about(axis: str, angle: float) -> tuple[float, float, float, float]:
    s = math.sin(angle / 2.0)
    return s * (axis == "x"), s * (axis == "y"), s * (axis == "z"), math.cos(angle / 2.0)
