"""Quaternions (x, y, z, w). Imports NumPy."""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from tf.transformations._vectors import EPS, unit_vector, vector_norm

Numbers = tuple[float, float, float, float]


def quaternion_about_axis(angle: float, axis: Any) -> Any:
    """Return the rotation about an axis of any length, by an angle in rad."""
    length = vector_norm(axis[:3])
    s = math.sin(angle / 2.0) / length if length > EPS else 1.0
    return np.array((*(s * each for each in axis[:3]), math.cos(angle / 2.0)), dtype=np.float64)


def quaternion_matrix(quaternion: Any) -> Any:
    """Return the homogeneous matrix of a rotation of any length but 0, for which it is the identity."""
    x, y, z, w = map(float, quaternion[:4])
    length2 = x * x + y * y + z * z + w * w
    if length2 < EPS:
        return np.identity(4)
    s = math.sqrt(2.0 / length2)
    x, y, z, w = x * s, y * s, z * s, w * s
    return np.array(
        (
            (1.0 - y * y - z * z, x * y - z * w, x * z + y * w, 0.0),
            (x * y + z * w, 1.0 - x * x - z * z, y * z - x * w, 0.0),
            (x * z - y * w, y * z + x * w, 1.0 - x * x - y * y, 0.0),
            (0.0, 0.0, 0.0, 1.0),
        )
    )


def quaternion_from_matrix(matrix: Any) -> Any:
    """Return the rotation of a homogeneous matrix."""
    m = np.asarray(matrix, dtype=np.float64)[:4, :4].tolist()
    one = m[3][3]
    total = m[0][0] + m[1][1] + m[2][2] + one
    found = [m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1], total]
    if total <= one:
        i = max(range(3), key=lambda axis: m[axis][axis])
        j, k = (i + 1) % 3, (i + 2) % 3
        total = m[i][i] - (m[j][j] + m[k][k]) + one
        found[3] = found[i]
        found[i], found[j], found[k] = total, m[i][j] + m[j][i], m[k][i] + m[i][k]
    return np.array(found) * (0.5 / math.sqrt(total * one))


def quaternion_product(a: Iterable[float], b: Iterable[float]) -> Numbers:
    """First rotation b, then a, as plain numbers."""
    ax, ay, az, aw = a
    bx, by, bz, bw = b
    return (
        ax * bw + ay * bz - az * by + aw * bx,
        -ax * bz + ay * bw + az * bx + aw * by,
        ax * by - ay * bx + az * bw + aw * bz,
        -ax * bx - ay * by - az * bz + aw * bw,
    )


def quaternion_multiply(quaternion1: Any, quaternion0: Any) -> Any:
    """First rotation 0, then rotation 1."""
    return np.array(quaternion_product(quaternion1, quaternion0), dtype=np.float64)


def quaternion_conjugate(quaternion: Any) -> Any:
    """Return the quaternion with its vector part negated. For length 1, it is the inverse rotation."""
    x, y, z, w = quaternion[:4]
    return np.array((-x, -y, -z, w), dtype=np.float64)


def quaternion_inverse(quaternion: Any) -> Any:
    """Return the inverse rotation."""
    return quaternion_conjugate(quaternion) / np.dot(quaternion, quaternion)


def quaternion_slerp(quat0: Any, quat1: Any, fraction: float, spin: int = 0, shortestpath: bool = True) -> Any:
    """Return the rotation between two, at constant speed.

    Args:
        quat0: where `fraction` is 0.
        quat1: where `fraction` is 1.
        fraction: the point between them, or beyond.
        spin: how many half turns more to make on the way.
        shortestpath: take the short way round.
    """
    q0, q1 = unit_vector(quat0[:4]), unit_vector(quat1[:4])
    if fraction in (0.0, 1.0):
        return q1 if fraction else q0
    d = float(np.dot(q0, q1))
    if abs(abs(d) - 1.0) < EPS:
        return q0
    if shortestpath and d < 0.0:
        d, q1 = -d, -q1
    angle = math.acos(d) + spin * math.pi
    if abs(angle) < EPS:
        return q0
    return (q0 * math.sin((1.0 - fraction) * angle) + q1 * math.sin(fraction * angle)) / math.sin(angle)


def random_quaternion(rand: Any = None) -> Any:
    """Return a random rotation with uniform distribution.

    Args:
        rand: three random numbers from 0 to 1; None to draw them.
    """
    a, b, c = np.random.rand(3) if rand is None else rand
    small, large = math.sqrt(1.0 - a), math.sqrt(a)
    first, second = 2.0 * math.pi * b, 2.0 * math.pi * c
    return np.array(
        (math.sin(first) * small, math.cos(first) * small, math.sin(second) * large, math.cos(second) * large)
    )


def random_rotation_matrix(rand: Any = None) -> Any:
    """Return the matrix of `random_quaternion`."""
    return quaternion_matrix(random_quaternion(rand))
