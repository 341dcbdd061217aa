"""Elementary homogeneous matrices: made from their parameters, and decomposed again. Imports NumPy."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tf.transformations._vectors import eigenvectors, fixed_point, unit_vector, vector_norm


def identity_matrix() -> Any:
    """Return the identity matrix."""
    return np.identity(4)


def translation_matrix(direction: Any) -> Any:
    """Return the matrix that moves by a vector."""
    found = np.identity(4)
    found[:3, 3] = direction[:3]
    return found


def translation_from_matrix(matrix: Any) -> Any:
    """Return the vector that a matrix moves by."""
    return np.array(matrix)[:3, 3]


def reflection_matrix(point: Any, normal: Any) -> Any:
    """Return the matrix that mirrors at a plane.

    Args:
        point: on the plane.
        normal: orthogonal to it, of any length.
    """
    n = unit_vector(normal[:3])
    found = np.identity(4)
    found[:3, :3] -= 2.0 * np.outer(n, n)
    found[:3, 3] = 2.0 * np.dot(point[:3], n) * n
    return found


def reflection_from_matrix(matrix: Any) -> tuple[Any, Any]:
    """Return the point and normal of the plane that a matrix mirrors at.

    Raises:
        ValueError: it does not mirror.
    """
    m = np.asarray(matrix, dtype=np.float64)
    normals = eigenvectors(m[:3, :3], -1.0)
    if not normals:
        raise ValueError("no unit eigenvector corresponding to eigenvalue -1")
    return fixed_point(m), normals[0]


def rotation_matrix(angle: float, direction: Any, point: Any = None) -> Any:
    """Return the matrix of a rotation about an axis.

    Args:
        angle: in rad.
        direction: direction of the axis, of any length.
        point: on the axis; None for the origin.
    """
    x, y, z = unit_vector(direction[:3]).tolist()
    s, c = math.sin(angle), math.cos(angle)
    rest = 1.0 - c
    found = np.identity(4)
    found[:3, :3] = (
        (c + x * x * rest, x * y * rest - z * s, x * z * rest + y * s),
        (x * y * rest + z * s, c + y * y * rest, y * z * rest - x * s),
        (x * z * rest - y * s, y * z * rest + x * s, c + z * z * rest),
    )
    if point is not None:
        at = np.array(point[:3], dtype=np.float64)
        found[:3, 3] = at - found[:3, :3] @ at
    return found


def rotation_from_matrix(matrix: Any) -> tuple[float, Any, Any]:
    """Return the angle in rad, direction of the axis, and a point on it, of a matrix that turns.

    Raises:
        ValueError: it does not turn.
    """
    m = np.asarray(matrix, dtype=np.float64)
    turn = m[:3, :3]
    axes = eigenvectors(turn.T, 1.0)
    if not axes:
        raise ValueError("no unit eigenvector corresponding to eigenvalue 1")
    x, y, z = axes[-1].tolist()
    cosine = (float(np.trace(turn)) - 1.0) / 2.0
    if abs(z) > 1e-8:
        sine = (m[1, 0] + (cosine - 1.0) * x * y) / z
    elif abs(y) > 1e-8:
        sine = (m[0, 2] + (cosine - 1.0) * x * z) / y
    else:
        sine = (m[2, 1] + (cosine - 1.0) * y * z) / x
    return math.atan2(sine, cosine), axes[-1], fixed_point(m)


def scale_matrix(factor: float, origin: Any = None, direction: Any = None) -> Any:
    """Return the matrix that scales.

    Args:
        factor: scale factor.
        origin: the point that stays; None for the origin.
        direction: direction of scaling; None for all directions.
    """
    found = np.identity(4)
    if direction is None:
        found[:3, :3] *= factor
        if origin is not None:
            found[:3, 3] = np.asarray(origin[:3]) * (1.0 - factor)
        return found
    along = unit_vector(direction[:3])
    found[:3, :3] -= (1.0 - factor) * np.outer(along, along)
    if origin is not None:
        found[:3, 3] = (1.0 - factor) * np.dot(origin[:3], along) * along
    return found


def scale_from_matrix(matrix: Any) -> tuple[float, Any, Any]:
    """Return the factor, origin, and direction (None for all) of a matrix that scales.

    Raises:
        ValueError: it does not scale.
    """
    m = np.asarray(matrix, dtype=np.float64)
    factor = float(np.trace(m[:3, :3])) - 2.0
    directions = eigenvectors(m[:3, :3], factor)
    origin = fixed_point(m, "no eigenvector corresponding to eigenvalue 1")
    if not directions:
        return (factor + 2.0) / 3.0, origin, None
    return factor, origin, directions[0] / vector_norm(directions[0])


def shear_matrix(angle: float, direction: Any, point: Any, normal: Any) -> Any:
    """Return the matrix that shears along a plane.

    Args:
        angle: angle of the shear, in rad.
        direction: direction of the movement, in the plane.
        point: on the plane.
        normal: orthogonal to it.

    Raises:
        ValueError: direction and normal are not orthogonal.
    """
    across, along = unit_vector(normal[:3]), unit_vector(direction[:3])
    if abs(np.dot(across, along)) > 1e-6:
        raise ValueError("direction and normal vectors are not orthogonal")
    slope = math.tan(angle)
    found = np.identity(4)
    found[:3, :3] += slope * np.outer(along, across)
    found[:3, 3] = -slope * np.dot(point[:3], across) * along
    return found


def shear_from_matrix(matrix: Any) -> tuple[float, Any, Any, Any]:
    """Return the angle in rad, direction, point and normal of a matrix that shears.

    Raises:
        ValueError: it does not shear.
    """
    m = np.asarray(matrix, dtype=np.float64)
    plane = eigenvectors(m[:3, :3], 1.0, 1e-4)
    if len(plane) < 2:
        raise ValueError(f"No two linear independent eigenvectors found {np.linalg.eig(m[:3, :3])[0]}")
    pairs = [(a, b) for at, a in enumerate(plane) for b in plane[at + 1 :]]
    normal = max((np.cross(a, b) for a, b in pairs), key=vector_norm)
    normal = normal / vector_norm(normal)
    moved = (m[:3, :3] - np.identity(3)) @ normal
    slope = vector_norm(moved)
    return math.atan(slope), moved / slope, fixed_point(m, "no eigenvector corresponding to eigenvalue 1"), normal
