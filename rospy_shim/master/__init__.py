"""ROS's XML-RPC side of a mission: the master (rosmaster) and the nodes' slave API, found by URI without a network.

`Switchboard` knows who answers at which URI; `xmlrpc_client` gives a node the `xmlrpc.client` that asks there. May
import cfepy.nodes and rospy_shim.
"""

from __future__ import annotations

from rospy_shim.master.proxy import make_get_master, make_master_proxy
from rospy_shim.master.switchboard import MASTER_PORT, Switchboard
from rospy_shim.master.xmlrpc_client import xmlrpc_client

__all__ = ["MASTER_PORT", "Switchboard", "make_get_master", "make_master_proxy", "xmlrpc_client"]
