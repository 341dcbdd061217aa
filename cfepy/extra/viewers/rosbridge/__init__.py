"""The rosbridge protocol: clients such as roslibjs and roslibpy take part in a running mission (`--rosbridge`).

A module belongs here if it speaks the protocol of rosbridge_suite's rosbridge_websocket over WebSockets, or answers for
rosapi. The entries of outside nodes in the mission's graph belong to `rospy_shim.graph.outside`; admission belongs to
`cfepy.extra.viewers.listen`.
"""

from __future__ import annotations

from cfepy.extra.viewers.rosbridge.server import RosbridgeServer

__all__ = ["RosbridgeServer"]
