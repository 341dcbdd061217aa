"""ROS's XML-RPC side of a mission: the master (rosmaster) and the nodes' slave API, found by URI without a network.

A module belongs here if it answers XML-RPC calls or carries them: `Switchboard` finds the object that answers at a URI;
`xmlrpc_client` gives a node an `xmlrpc.client` that asks there. The graph itself belongs to `rospy_shim.graph`. The
central file is `rospy_shim/master/switchboard.py`.
"""

from __future__ import annotations

from rospy_shim.master.proxy import make_get_master, make_master_proxy
from rospy_shim.master.switchboard import MASTER_PORT, Switchboard, xmlrpc_client

__all__ = ["MASTER_PORT", "Switchboard", "make_get_master", "make_master_proxy", "xmlrpc_client"]
