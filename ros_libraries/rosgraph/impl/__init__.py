"""rosgraph.impl: the base of ROS's graph tools."""

from __future__ import annotations

from rosgraph.impl import graph

__all__ = ["graph"]
