"""rosgraph.impl: what ROS's graph tools stand on."""

from __future__ import annotations

from rosgraph.impl import graph

__all__ = ["graph"]
