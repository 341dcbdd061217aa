"""A stand-in for nose, whose helpers tests of ROS packages import; Python's own unittest does the work."""

from __future__ import annotations

from unittest import SkipTest

__all__ = ["SkipTest"]
