"""ROS 1 on this computer and a paced mission as one graph: `cfepy run --realtime --ros-master`.

What belongs here speaks ROS's protocols on real sockets: XML-RPC of master and nodes, TCPROS of topics and services.
What the mission's graph is and answers is `rospy_shim.graph` and `rospy_shim.master`; what outside nodes have in it,
`rospy_shim.graph.outside`.
"""

from __future__ import annotations

from collections.abc import Callable

from cfepy.ros_host.host import RosHost
from cfepy.ros_host.joined_master import JoinedMaster
from cfepy.ros_host.message_package import telemetry_package
from cfepy.ros_host.served_master import MASTER_PORT, ServedMaster
from cfepy.ros_host.world import RosWorld

__all__ = ["JoinedMaster", "RosHost", "ServedMaster", "telemetry_package", "world_at"]

SERVE = "serve"


def world_at(text: str) -> Callable[[RosHost], RosWorld]:
    """What an option says: the URI of a master to join, or `serve` and `serve:PORT` for one to serve."""
    word, _, port = text.partition(":")
    if word == SERVE:
        return lambda host: ServedMaster(host, int(port) if port else MASTER_PORT)
    return lambda host: JoinedMaster(host, text)
