"""rosgraph: the ROS graph for programs without rospy, i.e. the master, names, addresses, the environment.

Source: wiki.ros.org/rosgraph. It uses `xmlrpc.client` and the node's environment.
"""

from __future__ import annotations

import sys
from collections.abc import Sequence

from rosgraph import masterapi, names, network, rosenv, roslogging
from rosgraph.masterapi import Master, MasterError, MasterException, MasterFailure
from rosgraph.masterapi import is_online as is_master_online
from rosgraph.rosenv import ROS_HOSTNAME, ROS_IP, ROS_IPV6, ROS_MASTER_URI, ROS_NAMESPACE, get_master_uri

__all__ = [
    "ROS_HOSTNAME",
    "ROS_IP",
    "ROS_IPV6",
    "ROS_MASTER_URI",
    "ROS_NAMESPACE",
    "Master",
    "MasterError",
    "MasterException",
    "MasterFailure",
    "get_master_uri",
    "is_master_online",
    "masterapi",
    "myargv",
    "names",
    "network",
    "rosenv",
    "roslogging",
]


def myargv(argv: Sequence[str] | None = None) -> list[str]:
    """Return a command line without ROS's arguments.

    Args:
        argv: the command line; sys.argv by default.
    """
    return [argument for argument in (sys.argv if argv is None else argv) if names.REMAP not in argument]
