"""Arithmetic on rigid transforms as plain floats, in the order of operations of tf2's LinearMath.

A transform is `(x, y, z, qx, qy, qz, qw)`: a translation, then a rotation as a quaternion. Everything is written out,
because a lookup spends its time here. Imports nothing.
"""

from __future__ import annotations

from collections.abc import Iterable
from math import acos, sin, sqrt

Rigid = tuple[float, float, float, float, float, float, float]
Quaternion = tuple[float, float, float, float]
Matrix = tuple[float, float, float, float, float, float, float, float, float]
Sample = tuple[str, float, float, float, float, float, float, float]
"""A transform at an instant, behind the name of its parent frame."""

IDENTITY: Rigid = (0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 1.0)


def compose(samples: Iterable[Sample]) -> Rigid:
    """Return the transform that applying all samples means, the first one first."""
    vx = vy = vz = qx = qy = qz = 0.0
    qw = 1.0
    for _, tx, ty, tz, x, y, z, w in samples:
        ax = w * vx + y * vz - z * vy
        ay = w * vy + z * vx - x * vz
        az = w * vz + x * vy - y * vx
        aw = -x * vx - y * vy - z * vz
        vx = ax * w - aw * x - ay * z + az * y + tx
        vy = ay * w - aw * y - az * x + ax * z + ty
        vz = az * w - aw * z - ax * y + ay * x + tz
        qx, qy, qz, qw = (
            w * qx + x * qw + y * qz - z * qy,
            w * qy + y * qw + z * qx - x * qz,
            w * qz + z * qw + x * qy - y * qx,
            w * qw - x * qx - y * qy - z * qz,
        )
    return vx, vy, vz, qx, qy, qz, qw


def inverse(transform: Rigid) -> Rigid:
    """Return the inverse transform. As in tf2 its rotation is multiplied by none, which decides the signs of zeros."""
    x, y, z, qx, qy, qz, qw = transform
    ax = qy * z - qw * x - qz * y
    ay = qz * x - qw * y - qx * z
    az = qx * y - qw * z - qy * x
    aw = -qx * x - qy * y - qz * z
    return (
        ax * qw + aw * qx + ay * qz - az * qy,
        ay * qw + aw * qy + az * qx - ax * qz,
        az * qw + aw * qz + ax * qy - ay * qx,
        qw * 0.0 - qx - qy * 0.0 + qz * 0.0,
        qw * 0.0 - qy - qz * 0.0 + qx * 0.0,
        qw * 0.0 - qz - qx * 0.0 + qy * 0.0,
        qw,
    )


def between(older: Sample, newer: Sample, ratio: float) -> Sample:
    """Return the sample at a point between two: linear translation, rotation along the shortest arc.

    Args:
        older: the sample for `ratio` 0.
        newer: the sample for `ratio` 1; its parent does not count.
        ratio: the point.
    """
    parent, ax, ay, az, x, y, z, w = older
    _, bx, by, bz, ox, oy, oz, ow = newer
    rest = 1.0 - ratio
    ax, ay, az = rest * ax + ratio * bx, rest * ay + ratio * by, rest * az + ratio * bz
    dot = x * ox + y * oy + z * oz + w * ow
    cosine = abs(dot) / sqrt((x * x + y * y + z * z + w * w) * (ox * ox + oy * oy + oz * oz + ow * ow))
    if cosine >= 1.0:
        return parent, ax, ay, az, x, y, z, w
    angle = acos(cosine)
    scale = 1.0 / sin(angle)
    rest = sin(rest * angle)
    part = sin(ratio * angle) if dot >= 0 else -sin(ratio * angle)
    return (
        parent,
        ax,
        ay,
        az,
        (x * rest + ox * part) * scale,
        (y * rest + oy * part) * scale,
        (z * rest + oz * part) * scale,
        (w * rest + ow * part) * scale,
    )


def matrix_of(q: Quaternion) -> Matrix:
    """Return the rotation matrix of a quaternion, row by row. The quaternion's length does not matter."""
    x, y, z, w = q
    s = 2.0 / (x * x + y * y + z * z + w * w)
    xs, ys, zs = x * s, y * s, z * s
    wx, wy, wz = w * xs, w * ys, w * zs
    xx, xy, xz = x * xs, x * ys, x * zs
    yy, yz, zz = y * ys, y * zs, z * zs
    return 1.0 - (yy + zz), xy - wz, xz + wy, xy + wz, 1.0 - (xx + zz), yz - wx, xz - wy, yz + wx, 1.0 - (xx + yy)


def quaternion_of(matrix: Matrix) -> Quaternion:
    """Return the quaternion of a rotation matrix, with the sign that keeps most digits."""
    rows = matrix[0:3], matrix[3:6], matrix[6:9]
    trace = matrix[0] + matrix[4] + matrix[8]
    if trace > 0.0:
        s = sqrt(trace + 1.0)
        f = 0.5 / s
        return (
            (matrix[7] - matrix[5]) * f,
            (matrix[2] - matrix[6]) * f,
            (matrix[3] - matrix[1]) * f,
            s * 0.5,
        )
    i = max(range(3), key=lambda axis: rows[axis][axis])
    j, k = (i + 1) % 3, (i + 2) % 3
    s = sqrt(rows[i][i] - rows[j][j] - rows[k][k] + 1.0)
    f = 0.5 / s
    found = [0.0, 0.0, 0.0, (rows[k][j] - rows[j][k]) * f]
    found[i] = s * 0.5
    found[j] = (rows[j][i] + rows[i][j]) * f
    found[k] = (rows[k][i] + rows[i][k]) * f
    return found[0], found[1], found[2], found[3]


def product(second: Rigid, first: Rigid) -> Rigid:
    """First one, then the other, by way of matrices, as tf2::Transform does: normalises the rotation."""
    a, b = matrix_of(second[3:]), matrix_of(first[3:])
    x, y, z = first[:3]
    rows = (a[0:3], a[3:6], a[6:9])
    moved = [row[0] * x + row[1] * y + row[2] * z + offset for row, offset in zip(rows, second[:3], strict=True)]
    cells = [b[at] * row[0] + b[at + 3] * row[1] + b[at + 6] * row[2] for row in rows for at in range(3)]
    rotation = quaternion_of((cells[0], cells[1], cells[2], cells[3], cells[4], cells[5], cells[6], cells[7], cells[8]))
    return moved[0], moved[1], moved[2], *rotation
