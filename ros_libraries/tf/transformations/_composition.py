"""Matrices composed of several steps, decomposed into them, or fitted to points. Imports NumPy."""

from __future__ import annotations

import math
from functools import reduce
from typing import Any

import numpy as np

from tf.transformations._euler import euler_matrix
from tf.transformations._quaternions import quaternion_matrix
from tf.transformations._vectors import EPS, vector_norm

Parts = tuple[Any, list[Any], list[float], Any, Any]


def decompose_matrix(matrix: Any) -> Parts:
    """Return the steps of a homogeneous matrix, as `compose_matrix` takes them.

    Returns:
        scale factors for x, y, z; shear factors for x-y, x-z, y-z; angles in rad about the fixed axes x, y, z;
        translation; perspective, the last row.

    Raises:
        ValueError: the matrix cannot be decomposed.
    """
    m = np.array(matrix, dtype=np.float64).T
    if abs(m[3, 3]) < EPS:
        raise ValueError("M[3, 3] is zero")
    m /= m[3, 3]
    affine = m.copy()
    affine[:, 3] = 0, 0, 0, 1
    if not np.linalg.det(affine):
        raise ValueError("Matrix is singular")
    perspective = np.array((0.0, 0.0, 0.0, 1.0))
    if any(abs(m[:3, 3]) > EPS):
        perspective = m[:, 3] @ np.linalg.inv(affine.T)
    rows, scale, shear = _orthogonal(m[:3, :3].copy())
    return scale, shear, _angles(rows), m[3, :3].copy(), perspective


def _orthogonal(rows: Any) -> tuple[Any, Any, list[Any]]:
    """Return rows of a rotation, and the scale and shear that were in them (Gram and Schmidt)."""
    scale, shear = np.zeros(3), [0.0, 0.0, 0.0]
    scale[0] = vector_norm(rows[0])
    rows[0] /= scale[0]
    shear[0] = np.dot(rows[0], rows[1])
    rows[1] -= rows[0] * shear[0]
    scale[1] = vector_norm(rows[1])
    rows[1] /= scale[1]
    shear[0] /= scale[1]
    shear[1] = np.dot(rows[0], rows[2])
    rows[2] -= rows[0] * shear[1]
    shear[2] = np.dot(rows[1], rows[2])
    rows[2] -= rows[1] * shear[2]
    scale[2] = vector_norm(rows[2])
    rows[2] /= scale[2]
    shear[1:] = [each / scale[2] for each in shear[1:]]
    sign = -1.0 if np.dot(rows[0], np.cross(rows[1], rows[2])) < 0 else 1.0
    return rows * sign, scale * sign, shear


def _angles(rows: Any) -> list[float]:
    middle = math.asin(-rows[0, 2])
    if math.cos(middle):
        return [math.atan2(rows[1, 2], rows[2, 2]), middle, math.atan2(rows[0, 1], rows[0, 0])]
    return [math.atan2(-rows[2, 1], rows[1, 1]), middle, 0.0]


def compose_matrix(
    scale: Any = None, shear: Any = None, angles: Any = None, translate: Any = None, perspective: Any = None
) -> Any:
    """Return the homogeneous matrix of several steps, each left out when it is None.

    Args:
        scale: factors for x, y, z.
        shear: factors for x-y, x-z, y-z.
        angles: in rad, about the fixed axes x, y, z.
        translate: a vector.
        perspective: the last row.
    """
    found = np.identity(4)
    if perspective is not None:
        found[3, :] = perspective[:4]
    if translate is not None:
        moved = np.identity(4)
        moved[:3, 3] = translate[:3]
        found = found @ moved
    if angles is not None:
        found = found @ euler_matrix(angles[0], angles[1], angles[2])
    if shear is not None:
        sheared = np.identity(4)
        sheared[0, 1], sheared[0, 2], sheared[1, 2] = shear
        found = found @ sheared
    if scale is not None:
        found = found @ np.diag((*scale, 1.0))
    return found / found[3, 3]


def orthogonalization_matrix(lengths: Any, angles: Any) -> Any:
    """Return the matrix from a crystal's cell to orthogonal coordinates.

    Args:
        lengths: of the cell's three edges.
        angles: between them, in degrees.
    """
    a, b, c = lengths
    alpha, beta, gamma = np.radians(angles).tolist()
    sin_a, sin_b, cos_a, cos_b = math.sin(alpha), math.sin(beta), math.cos(alpha), math.cos(beta)
    co = (cos_a * cos_b - math.cos(gamma)) / (sin_a * sin_b)
    found = np.identity(4)
    found[0, 0] = a * sin_b * math.sqrt(1.0 - co * co)
    found[1, :2] = -a * sin_b * co, b * sin_a
    found[2, :3] = a * cos_b, b * cos_a, c
    return found


def superimposition_matrix(v0: Any, v1: Any, scaling: bool = False, usesvd: bool = True) -> Any:
    """Return the matrix that brings points closest to other points: it turns, moves, and scales if asked to.

    Args:
        v0: the points, an array of 3 or 4 rows.
        v1: where they belong.
        scaling: scale as well.
        usesvd: find the rotation by Kabsch's method, otherwise by Horn's.

    Raises:
        ValueError: the numbers of points differ, or are below 3.
    """
    old, new = np.asarray(v0, dtype=np.float64)[:3], np.asarray(v1, dtype=np.float64)[:3]
    if old.shape != new.shape or old.shape[1] < 3:
        raise ValueError("Vector sets are of wrong shape or type.")
    from_centre, to_centre = np.mean(old, axis=1), np.mean(new, axis=1)
    old, new = old - from_centre[:, np.newaxis], new - to_centre[:, np.newaxis]
    found = _kabsch(old, new) if usesvd else _horn(old, new)
    if scaling:
        found[:3, :3] *= math.sqrt(np.sum(new * new) / np.sum(old * old))
    found[:3, 3] = to_centre - found[:3, :3] @ from_centre
    return found


def _kabsch(old: Any, new: Any) -> Any:
    u, _, vh = np.linalg.svd(new @ old.T)
    turn = u @ vh
    if np.linalg.det(turn) < 0.0:
        turn -= np.outer(u[:, 2], vh[2, :] * 2.0)
    found = np.identity(4)
    found[:3, :3] = turn
    return found


def _horn(old: Any, new: Any) -> Any:
    (xx, xy, xz), (yx, yy, yz), (zx, zy, zz) = old @ new.T
    n = (
        (xx + yy + zz, yz - zy, zx - xz, xy - yx),
        (yz - zy, xx - yy - zz, xy + yx, zx + xz),
        (zx - xz, xy + yx, -xx + yy - zz, yz + zy),
        (xy - yx, zx + xz, yz + zy, -xx - yy + zz),
    )
    values, vectors = np.linalg.eig(n)
    w, x, y, z = np.real(vectors[:, np.argmax(np.real(values))])
    return quaternion_matrix((x, y, z, w))


def inverse_matrix(matrix: Any) -> Any:
    """Return the inverse of a square matrix."""
    return np.linalg.inv(matrix)


def concatenate_matrices(*matrices: Any) -> Any:
    """Return the product of homogeneous matrices."""
    return reduce(np.dot, matrices, np.identity(4))


def is_same_transform(matrix0: Any, matrix1: Any) -> bool:
    """Return whether two homogeneous matrices do the same."""
    first, second = np.array(matrix0, dtype=np.float64), np.array(matrix1, dtype=np.float64)
    return bool(np.allclose(first / first[3, 3], second / second[3, 3]))
