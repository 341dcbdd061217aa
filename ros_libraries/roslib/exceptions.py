"""roslib.exceptions: the base of roslib's errors."""

from __future__ import annotations


class ROSLibException(Exception):
    """Base of roslib's errors."""
