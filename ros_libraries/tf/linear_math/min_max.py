"""MinMax.h: the smaller and the larger of two values. Imports nothing."""

from __future__ import annotations


def tfMin(a: float, b: float) -> float:
    """Return the smaller of two values, or b if they are equal."""
    return a if a < b else b


def tfMax(a: float, b: float) -> float:
    """Return the larger of two values, or b if they are equal."""
    return a if a > b else b


def tfSetMin(a: float, b: float) -> float:
    """Return the new value of `a`: `b` if that is smaller."""
    return b if b < a else a


def tfSetMax(a: float, b: float) -> float:
    """Return the new value of `a`: `b` if that is larger."""
    return b if a < b else a
