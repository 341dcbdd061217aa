"""rospy.impl.init: defaults for the start of a node, and the handler that writes its log to the console."""

from __future__ import annotations

from rospy.impl._node import RosStreamHandler

__all__ = ["DEFAULT_MASTER_PORT", "DEFAULT_MASTER_URI", "DEFAULT_NODE_PORT", "RosStreamHandler"]

DEFAULT_NODE_PORT = 0
DEFAULT_MASTER_PORT = 11311
DEFAULT_MASTER_URI = f"http://localhost:{DEFAULT_MASTER_PORT}/"
