"""Who answers at which URI: the master, and the nodes of the mission.

Imports nothing of cfepy.
"""

from __future__ import annotations

from typing import TYPE_CHECKING
from urllib.parse import urlsplit

from rospy_shim.master.master_api import MasterApi
from rospy_shim.master.registry import uri_of
from rospy_shim.master.slave_api import SlaveApi

if TYPE_CHECKING:
    from rospy_shim.graph import Graph
    from rospy_shim.node import Node

MASTER_PORT = 11311
HERE = frozenset({"cfepy", "localhost", "127.0.0.1", "127.0.1.1", "[::1]"})


class Switchboard:
    """Connects XML-RPC requests.

    Args:
        graph: the mission's ROS graph.
    """

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._master = MasterApi(graph, f"http://cfepy:{MASTER_PORT}/")

    def find(self, asker: Node, address: str) -> MasterApi | SlaveApi | None:
        """Who answers, or None.

        Args:
            asker: the node that asks; its ROS_MASTER_URI names the master, whatever host that is.
            address: host and port, as they stand in a URI.
        """
        place = _place(address)
        if place in (_place(f"cfepy:{MASTER_PORT}"), _place(_host(asker.universe.environ.get("ROS_MASTER_URI", "")))):
            return self._master
        for node in self._graph.nodes.values():
            if place == _place(_host(uri_of(node))):
                return SlaveApi(node, self._master)
        return None


def _host(uri: str) -> str:
    try:
        return urlsplit(uri).netloc
    except ValueError:
        return ""


def _place(address: str) -> tuple[str, str]:
    """Host and port; all names of this machine are one."""
    host, _, port = address.rpartition("@")[2].rpartition(":")
    return ("cfepy" if host in HERE else host), port
