"""The answers of a compiled node to calls at its URI (wiki.ros.org/ROS/Slave_API).

The node itself receives the Software Bus only, so the graph answers in its place. Commands of ES end it, so it has no
method `shutdown`.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING, Any

from rospy_shim.master import xmlrpc_calls as calls
from rospy_shim.master.registrations import uri_of
from rospy_shim.master.slave_api import TRANSPORT, NodeApi, service_header
from rospy_shim.master.xmlrpc_calls import Answer, answers

if TYPE_CHECKING:
    from rospy_shim.graph.compiled import CompiledNode
    from rospy_shim.graph.graph import Graph


class CompiledApi(NodeApi):
    """The slave API of a compiled node. Its process number is unique, although all compiled nodes are one process.

    Args:
        node: the node.
        graph: the mission's ROS graph.
        master_uri: URI of the master.
    """

    def __init__(self, node: CompiledNode, graph: Graph, master_uri: str) -> None:
        super().__init__(node, node.pid)
        self._node = node
        self._graph = graph
        self._master_uri = master_uri

    @answers("")
    def getMasterUri(self, caller: str) -> Answer:
        """Return the master's URI."""
        return 1, self._master_uri, self._master_uri

    @answers([])
    def getSubscriptions(self, caller: str) -> Answer:
        """Return [topic, type] of the subscribed topics."""
        return 1, "subscriptions", [list(each) for each in self._node.subscribed.items()]

    @answers([])
    def getPublications(self, caller: str) -> Answer:
        """Return [topic, type] of the published topics."""
        return 1, "publications", [list(each) for each in self._node.published.items()]

    def _connections(self) -> Iterator[tuple[str, str, str, str, bool, str]]:
        for name in self._node.published:
            topic = self._graph.topic(name)
            hear: list[Any] = [*(each.node for each in topic.subscriptions), *topic.compiled_subscribers]
            for node in hear:
                text = f"{TRANSPORT} connection on MsgId 0x{topic.msg_id:04X} to [{node.names.name}]"
                yield node.names.name, "o", TRANSPORT, name, True, text
        for name in self._node.subscribed:
            topic = self._graph.topic(name)
            say: list[Any] = [*(each.node for each in topic.links), *topic.compiled_publishers]
            for node in say:
                text = f"{TRANSPORT} connection on MsgId 0x{topic.msg_id:04X} to [{uri_of(node)}]"
                yield uri_of(node), "i", TRANSPORT, name, True, text

    @answers({}, calls.name_of_thing("service"))
    def getServiceHeader(self, caller: str, service: str) -> Answer:
        """Return the header that a probe of the service gets: type and md5sum."""
        entry = self._graph.services.get(service)
        if entry is None or entry.service.__node__ is not self._node:
            return -1, f"Not a provider of [{service}]", {}
        return 1, "service header", service_header(self._node.names.name, service, entry.service.service_class)
