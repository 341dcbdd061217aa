"""The rosbridge protocol: clients such as roslibjs and roslibpy take part in a mission that runs (`--rosbridge`).

What belongs here speaks what rosbridge_suite's rosbridge_websocket speaks over WebSockets, and answers for rosapi.
What outside nodes have in the mission's graph is `rospy_shim.graph.outside`; who is let in,
`cfepy.extra.viewers.listen`.
"""

from __future__ import annotations

from cfepy.extra.viewers.rosbridge.server import RosbridgeServer

__all__ = ["RosbridgeServer"]
