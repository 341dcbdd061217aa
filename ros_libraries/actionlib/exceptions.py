"""The one exception of actionlib."""

from __future__ import annotations


class ActionException(Exception):
    """A class that should be an action's type is not."""
