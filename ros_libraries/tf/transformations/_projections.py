"""Matrices that project onto a plane or into a view. Imports NumPy."""

from __future__ import annotations

from typing import Any

import numpy as np

from tf.transformations._vectors import EPS, eigenvectors, unit_vector, vector_norm


def projection_matrix(
    point: Any, normal: Any, direction: Any = None, perspective: Any = None, pseudo: bool = False
) -> Any:
    """Return the matrix that projects onto a plane.

    Args:
        point: on the plane.
        normal: orthogonal to it.
        direction: direction of a parallel projection; None for the normal's.
        perspective: the centre of a perspective projection; None for a parallel one.
        pseudo: in a perspective projection, keep relative depths.
    """
    at = np.array(point[:3], dtype=np.float64)
    n = unit_vector(normal[:3])
    if perspective is not None:
        return _perspective(at, n, np.array(perspective[:3], dtype=np.float64), pseudo)
    along = n if direction is None else np.array(direction[:3], dtype=np.float64)
    scale = 1.0 if direction is None else np.dot(along, n)
    found = np.identity(4)
    found[:3, :3] -= np.outer(along, n) / scale
    found[:3, 3] = along * (np.dot(at, n) / scale)
    return found


def _perspective(point: Any, normal: Any, centre: Any, pseudo: bool) -> Any:
    found = np.identity(4)
    found[:3, :3] *= np.dot(centre - point, normal)
    found[:3, :3] -= np.outer(centre, normal)
    found[:3, 3] = np.dot(point, normal) * centre
    if pseudo:
        found[:3, :3] -= np.outer(normal, normal)
        found[:3, 3] = np.dot(point, normal) * (centre + normal)
    found[3, :3] = -normal
    found[3, 3] = np.dot(centre, normal)
    return found


def projection_from_matrix(matrix: Any, pseudo: bool = False) -> tuple[Any, Any, Any, Any, bool]:
    """Return the arguments of `projection_matrix` that make a matrix.

    Args:
        matrix: the matrix.
        pseudo: it was made with `pseudo`.

    Raises:
        ValueError: it does not project.
    """
    m = np.asarray(matrix, dtype=np.float64)
    points = eigenvectors(m, 1.0)
    if not pseudo and points:
        return _parallel_parts(m, points[-1] / points[-1][3])
    values, vectors = np.linalg.eig(m)
    (found,) = np.nonzero(abs(np.real(values)) > 1e-8)
    if not len(found):
        raise ValueError("no eigenvector not corresponding to eigenvalue 0")
    point = np.real(vectors[:, found[-1]])
    point = point / point[3]
    normal = -m[3, :3]
    centre = m[:3, 3] / np.dot(point[:3], normal)
    return point, normal, None, centre - normal if pseudo else centre, pseudo


def _parallel_parts(m: Any, point: Any) -> tuple[Any, Any, Any, Any, bool]:
    directions, normals = eigenvectors(m[:3, :3], 0.0), eigenvectors(m[:3, :3].T, 0.0)
    if not directions:
        raise ValueError("no eigenvector corresponding to eigenvalue 0")
    direction = directions[0] / vector_norm(directions[0])
    if not normals:
        return point, direction, None, None, False
    return point, normals[0] / vector_norm(normals[0]), direction, None, False


def clip_matrix(
    left: float, right: float, bottom: float, top: float, near: float, far: float, perspective: bool = False
) -> Any:
    """Return the matrix that makes a view's coordinates lie from -1 to 1.

    Args:
        left, right, bottom, top, near, far: edges of the view along x, y and z.
        perspective: the view is a pyramid with its tip at the origin, not a box.

    Raises:
        ValueError: the edges are the wrong way round, or a pyramid begins behind its tip.
    """
    if left >= right or bottom >= top or near >= far:
        raise ValueError("invalid frustrum")
    width, height, depth = right - left, top - bottom, far - near
    x, y, z = (right + left) / width, (top + bottom) / height, (far + near) / depth
    if not perspective:
        rows = ((2 / width, 0, 0, -x), (0, 2 / height, 0, -y), (0, 0, 2 / depth, -z), (0, 0, 0, 1))
        return np.array(rows, dtype=np.float64)
    if near <= EPS:
        raise ValueError("invalid frustrum: near <= 0")
    t = 2.0 * near
    return np.array(((-t / width, 0, x, 0), (0, -t / height, y, 0), (0, 0, -z, t * far / depth), (0, 0, -1, 0)))
