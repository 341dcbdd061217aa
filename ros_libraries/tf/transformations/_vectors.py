"""Lengths, unit vectors and eigenvectors. Imports NumPy."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

EPS = float(np.finfo(float).eps) * 4.0
_EIGEN_TOLERANCE = 1e-8


def vector_norm(data: Any, axis: int | None = None, out: Any = None) -> Any:
    """Return the Euclidean length.

    Args:
        data: a vector, or an array of vectors.
        axis: along which the vectors lie; None for the whole array.
        out: an array for the result.

    Returns:
        a number for a single vector, an array for several, None with `out`.
    """
    values = np.array(data, dtype=np.float64)
    if out is not None:
        np.sqrt(np.sum(values * values, axis=axis), out)
        return None
    if values.ndim == 1:
        return math.sqrt(np.dot(values, values))
    return np.sqrt(np.atleast_1d(np.sum(values * values, axis=axis)))


def unit_vector(data: Any, axis: int | None = None, out: Any = None) -> Any:
    """Vectors scaled to length 1.

    Args:
        data: a vector, or an array of vectors.
        axis: along which the vectors lie; None for the whole array.
        out: an array for the result.

    Returns:
        an array; None with `out`.
    """
    values = np.array(data, dtype=np.float64)
    if values.ndim == 1 and out is None:
        return values / math.sqrt(np.dot(values, values))
    length = np.sqrt(np.atleast_1d(np.sum(values * values, axis)))
    found = values / (length if axis is None else np.expand_dims(length, axis))
    if out is None:
        return found
    out[:] = found
    return None


def random_vector(size: Any) -> Any:
    """Return `size` random numbers from 0 up to 1."""
    return np.random.random(size)


def eigenvectors(matrix: Any, value: float, tolerance: float = _EIGEN_TOLERANCE) -> list[Any]:
    """Return the real parts of the eigenvectors of an eigenvalue, in LAPACK's order."""
    values, vectors = np.linalg.eig(matrix)
    (found,) = np.nonzero(abs(np.real(values) - value) < tolerance)
    return [np.real(vectors[:, at]) for at in found]


def fixed_point(matrix: Any, problem: str = "no unit eigenvector corresponding to eigenvalue 1") -> Any:
    """Return a point (x, y, z, 1) that a homogeneous matrix does not move.

    Raises:
        ValueError: there is none; `problem` is the text.
    """
    found = eigenvectors(matrix, 1.0)
    if not found:
        raise ValueError(problem)
    return found[-1] / found[-1][3]
