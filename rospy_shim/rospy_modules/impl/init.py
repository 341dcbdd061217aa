"""rospy.impl.init: defaults of a node's start, and what writes its log to the console."""

from __future__ import annotations

from rospy.impl._node import RosStreamHandler

__all__ = ["DEFAULT_MASTER_PORT", "DEFAULT_MASTER_URI", "DEFAULT_NODE_PORT", "RosStreamHandler"]

DEFAULT_NODE_PORT = 0
DEFAULT_MASTER_PORT = 11311
DEFAULT_MASTER_URI = f"http://localhost:{DEFAULT_MASTER_PORT}/"
