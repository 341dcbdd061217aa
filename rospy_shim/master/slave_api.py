"""The answers of a node to calls at its URI (wiki.ros.org/ROS/Slave_API), with rospy's codes and texts."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any
from urllib.parse import urlsplit

from rospy_shim.master import xmlrpc_calls as calls
from rospy_shim.master.registrations import uri_of
from rospy_shim.master.xmlrpc_calls import Answer, InvalidArgument, answers

if TYPE_CHECKING:
    from rospy_shim.client.node import Node
    from rospy_shim.client.topic_side import TopicSide
    from rospy_shim.graph.compiled import CompiledNode

TRANSPORT = "cFE SB"  # in place of TCPROS
TCPROS = "TCPROS"  # with nodes outside of the mission


def transport_of(side: TopicSide) -> str:
    """Return the transport of the messages to or from the other side of a connection."""
    return TCPROS if side.is_outside else TRANSPORT


def _global_name(value: Any, caller: str) -> Any:
    if not value or not isinstance(value, str):
        raise InvalidArgument("ERROR: parameter [parameter_key] must be a non-empty string")
    if not value.startswith("/"):
        raise InvalidArgument("ERROR: parameter [parameter_key] must be a globally referenced name")
    return value


def _uris(value: Any, caller: str) -> Any:
    if type(value) is not list:
        raise InvalidArgument("ERROR: param [publishers] must be a list")
    for each in value:
        if not isinstance(each, str):
            raise InvalidArgument("ERROR: param [publishers] must be a list of strings")
        if not all(urlsplit(each)[:2]):
            raise InvalidArgument(f"ERROR: param [publishers] does not contain valid URLs [{each}]")
    return value


class NodeApi(ABC):
    """The slave API of any node; each method takes the caller's name first and returns code, text and value.

    Args:
        asked: the node.
        pid: its process number.
    """

    def __init__(self, asked: Node | CompiledNode, pid: int) -> None:
        self._asked = asked
        self._pid = pid

    @answers("")
    def getUri(self, caller: str) -> Answer:
        """Return the URI of the node."""
        return 1, "", uri_of(self._asked)

    @answers("")
    def getName(self, caller: str) -> Answer:
        """Return the node's name."""
        return 1, "", self._asked.names.name

    @answers(-1)
    def getPid(self, caller: str) -> Answer:
        """Return the node's process number; for a node in Python, as its os.getpid() returns it."""
        return 1, "", self._pid

    @answers([])
    def getBusInfo(self, caller: str) -> Answer:
        """Return [number, other side, direction, transport, topic, connected, text] for each connection."""
        return 1, "bus info", [[number, *each] for number, each in enumerate(self._connections(), 1)]

    @abstractmethod
    def _connections(self) -> Iterable[tuple[str, str, str, str, bool, str]]:
        """Return the data of `getBusInfo` for each connection, without its number."""


class SlaveApi(NodeApi):
    """The slave API of a node in Python.

    Args:
        node: the node.
    """

    def __init__(self, node: Node) -> None:
        super().__init__(node, node.universe.pid)
        self._node = node

    @answers("")
    def getMasterUri(self, caller: str) -> Answer:
        """Return the master's URI as the node knows it."""
        uri = self._node.universe.environ.get("ROS_MASTER_URI", "")
        return (1, uri, uri) if uri else (0, "master URI not set", "")

    @answers(0, None)
    def shutdown(self, caller: str, reason: str) -> Answer:
        """Ask the node to shut down."""
        node = self._node
        node.universe.stdout.write(f"shutdown request: {reason}\n" if reason else "shutdown request\n")
        node.start_task(
            "shutdown", lambda: node.life.signal_shutdown(f"external shutdown request from [{caller}]: [{reason}]")
        )
        return 1, "shutdown", 0

    # -- topics ------------------------------------------------------------------------------------------------------

    @answers([])
    def getSubscriptions(self, caller: str) -> Answer:
        """Return [topic, type] of the subscribed topics."""
        return 1, "subscriptions", _types(self._node.subscriptions.items())

    @answers([])
    def getPublications(self, caller: str) -> Answer:
        """Return [topic, type] of the published topics."""
        return 1, "publications", _types(self._node.links.items())

    def _connections(self) -> Iterable[tuple[str, str, str, str, bool, str]]:
        for name, link in self._node.links.items():
            for each in link.peers:
                by = transport_of(each)
                text = f"{by} connection on MsgId 0x{link.msg_id:04X} to [{each.node.names.name}]"
                yield each.node.names.name, "o", by, name, True, text
        for name, subscription in self._node.subscriptions.items():
            for publisher in subscription.peers:
                by = transport_of(publisher)
                text = f"{by} connection on MsgId 0x{publisher.msg_id:04X} to [{uri_of(publisher.node)}]"
                yield uri_of(publisher.node), "i", by, name, True, text

    @answers([])
    def getBusStats(self, caller: str) -> Answer:
        """Return bytes and messages of publishers and subscribers, for each of their connections; services have
        none.
        """
        numbered = [[number, *each] for number, each in enumerate(self._connections(), 1)]
        sent = []
        for name, link in self._node.links.items():
            _, size, _ = link.get_stats()
            sent.append([name, size, [[each[0], size, link.seq, True] for each in _of(numbered, name, "o")]])
        received = []
        for name, subscription in self._node.subscriptions.items():
            rows = zip(_of(numbered, name, "i"), subscription.get_stats()[1], strict=False)
            received.append([name, [[each[0], *counted[1:]] for each, counted in rows]])
        return 1, "", [sent, received, []]

    @answers([], calls.name_of_thing("topic"), calls.something("protocols"))
    def requestTopic(self, caller: str, topic: str, protocols: Any) -> Answer:
        """Refuse: messages pass over the Software Bus, and there is no other protocol to choose."""
        if topic not in self._node.links:
            return -1, f"Not a publisher of [{topic}]", []
        return 0, "no supported protocol implementations", []

    @answers(-1, calls.name_of_thing("topic"), _uris)
    def publisherUpdate(self, caller: str, topic: str, publishers: list[str]) -> Answer:
        """Do nothing: the Software Bus knows the publishers."""
        return 1, "", 0

    @answers(-1, _global_name, None)
    def paramUpdate(self, caller: str, key: str, value: Any) -> Answer:
        """Change a parameter in the node's cache."""
        cache = self._node.params.cache
        try:
            if cache is not None:
                cache.update(key, self._node.params.unpacked(value))
                return 1, "", 0
        except KeyError:
            pass
        return -1, "not subscribed", 0

    # -- services ----------------------------------------------------------------------------------------------------

    @answers({}, calls.name_of_thing("service"))
    def getServiceHeader(self, caller: str, service: str) -> Answer:
        """Return the header that a probe of the service gets: type and md5sum. ROS asks at the service's own TCP
        port.
        """
        for each in self._node.services:
            if each.resolved_name == service:
                return 1, "service header", service_header(self._node.names.name, service, each.service_class)
        return -1, f"Not a provider of [{service}]", {}


def service_header(node: str, service: str, kind: Any) -> dict[str, str]:
    """Return the connection header of a service.

    Args:
        node: the node that offers it.
        service: its name.
        kind: its type, as a class or as a compiled node declares it.
    """
    return {"callerid": node, "md5sum": kind._md5sum, "service": service, "type": kind._type}


def _types(sides: Iterable[tuple[str, TopicSide]]) -> list[list[str]]:
    return [[name, side.data_class._type] for name, side in sides]


def _of(numbered: list[list[Any]], name: str, direction: str) -> list[list[Any]]:
    return [each for each in numbered if each[2] == direction and each[4] == name]
