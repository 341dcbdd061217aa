"""ROS 1 on this computer and a paced mission as one graph: `cfepy run --realtime --ros-master`.

A module belongs here if it speaks ROS's protocols on real sockets: XML-RPC of master and nodes, TCPROS of topics and
services. The mission's graph and its answers belong to `rospy_shim.graph` and `rospy_shim.master`; the entries of
outside nodes in it belong to `rospy_shim.graph.outside`. The central file is `cfepy/extra/ros_host/host.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.ros_host.host import RosHost
    from cfepy.extra.ros_host.joined_master import JoinedMaster
    from cfepy.extra.ros_host.message_package import telemetry_package
    from cfepy.extra.ros_host.served_master import MASTER_PORT, ServedMaster
    from cfepy.extra.ros_host.world import RosWorld

__all__ = ["MASTER_PORT", "JoinedMaster", "RosHost", "RosWorld", "ServedMaster", "telemetry_package"]

if not TYPE_CHECKING:  # a type checker sees only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".host": ("RosHost",),
            ".joined_master": ("JoinedMaster",),
            ".message_package": ("telemetry_package",),
            ".served_master": (
                "MASTER_PORT",
                "ServedMaster",
            ),
            ".world": ("RosWorld",),
        },
    )
