"""Rotates objects with a mouse: a ball under the pointer (Shoemake's Arcball). Imports NumPy."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from typing import Any

import numpy as np

from tf.transformations._quaternions import (
    quaternion_from_matrix,
    quaternion_matrix,
    quaternion_multiply,
    quaternion_slerp,
)
from tf.transformations._vectors import EPS, unit_vector, vector_norm


class Arcball:
    """A ball in a window.

    Args:
        initial: initial rotation: a quaternion (x, y, z, w) or a 4x4 matrix; None for no rotation.

    Raises:
        ValueError: `initial` is neither.
    """

    def __init__(self, initial: Any = None) -> None:
        self._axis: Any = None
        self._axes: list[Any] | None = None
        self._radius = 1.0
        self._center = (0.0, 0.0)
        self._vdown: Any = np.array((0.0, 0.0, 1.0))
        self._constrain = False
        self._qdown: Any = np.array((0.0, 0.0, 0.0, 1.0)) if initial is None else _turned(initial)
        self._qnow = self._qpre = self._qdown

    def place(self, center: Sequence[float], radius: float) -> None:
        """Say where the ball is in the window: centre and radius, in pixels."""
        self._radius = float(radius)
        self._center = (center[0], center[1])

    def setaxes(self, *axes: Any) -> None:
        """Set the axes that can constrain the rotation."""
        self._axes = [unit_vector(axis) for axis in axes]

    def setconstrain(self, constrain: Any) -> None:
        """Hold turning to the axes, or not."""
        self._constrain = constrain == True  # noqa: E712  # as in tf: anything else than True and 1 is not

    def getconstrain(self) -> bool:
        """Return whether the rotation is constrained to the axes."""
        return self._constrain

    def down(self, point: Sequence[float]) -> None:
        """Handle a press of the button at a point in pixels."""
        self._vdown = arcball_map_to_sphere(point, self._center, self._radius)
        self._qdown = self._qpre = self._qnow
        self._axis = None
        if self._constrain and self._axes is not None:
            self._axis = arcball_nearest_axis(self._vdown, self._axes)
            self._vdown = arcball_constrain_to_axis(self._vdown, self._axis)

    def drag(self, point: Sequence[float]) -> None:
        """Handle a move of the pointer to a point in pixels."""
        now = arcball_map_to_sphere(point, self._center, self._radius)
        if self._axis is not None:
            now = arcball_constrain_to_axis(now, self._axis)
        self._qpre = self._qnow
        across = np.cross(self._vdown, now)
        if np.dot(across, across) < EPS:
            self._qnow = self._qdown
        else:
            self._qnow = quaternion_multiply((*across, np.dot(self._vdown, now)), self._qdown)

    def next(self, acceleration: float = 0.0) -> None:
        """Go on turning as in the last drag, and faster."""
        further = quaternion_slerp(self._qpre, self._qnow, 2.0 + acceleration, False)
        self._qpre, self._qnow = self._qnow, further

    def matrix(self) -> Any:
        """How the ball is turned, as a homogeneous matrix."""
        return quaternion_matrix(self._qnow)


def _turned(initial: Any) -> Any:
    values = np.array(initial, dtype=np.float64)
    if values.shape == (4, 4):
        return quaternion_from_matrix(values)
    if values.shape == (4,):
        return values / vector_norm(values)
    raise ValueError("initial not a quaternion or matrix.")


def arcball_map_to_sphere(point: Sequence[float], center: Sequence[float], radius: float) -> Any:
    """Return the point of the unit sphere under a point of the window; outside of the ball, the nearest edge point."""
    x, y = (point[0] - center[0]) / radius, (center[1] - point[1]) / radius
    beyond = x * x + y * y
    if beyond > 1.0:
        length = math.sqrt(beyond)
        return np.array((x / length, y / length, 0.0))
    return np.array((x, y, math.sqrt(1.0 - beyond)))


def arcball_constrain_to_axis(point: Any, axis: Any) -> Any:
    """Return the point of the unit sphere nearest to another, in the plane orthogonal to an axis."""
    v, a = np.array(point, dtype=np.float64), np.array(axis, dtype=np.float64)
    v -= a * np.dot(a, v)
    length = vector_norm(v)
    if length > EPS:
        return v / (-length if v[2] < 0.0 else length)
    if a[2] == 1.0:
        return np.array((1.0, 0.0, 0.0))
    return unit_vector((-a[1], a[0], 0.0))


def arcball_nearest_axis(point: Any, axes: Iterable[Any]) -> Any:
    """Return the axis whose arc on the ball is nearest to a point, or None without axes."""
    at = np.asarray(point, dtype=np.float64)
    return max(axes, key=lambda axis: float(np.dot(arcball_constrain_to_axis(at, axis), at)), default=None)
