"""Common base of the two sides of a topic: its shared handles, its connections and its lock
(rospy.topics._TopicImpl).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

from cfepy.rtos import Mutex

if TYPE_CHECKING:
    from rospy_shim.client.node import Node
    from rospy_shim.graph.compiled import CompiledNode
    from rospy_shim.graph.graph import TopicEntry
    from rospy_shim.types.msgs import MessageClass

INBOUND, OUTBOUND, BIDIRECTIONAL = "i", "o", "b"  # rospy.impl.transport


class TopicConnection(NamedTuple):
    """A connection to a node at the other side, with the names that libraries such as actionlib use."""

    id: int
    endpoint_id: str  # a subscriber's name, or a publisher's URI
    callerid_pub: str
    direction: str  # "o" or "i"
    name: str  # of the topic
    type: str
    md5sum: str
    transport_type: str = "TCPROS"
    done: bool = False

    def get_transport_info(self) -> str:
        """Return rosnode's text for a connection."""
        return f"TCPROS connection on port {self.id} to [cfepy:{self.id} on socket {self.id}]"


def bus_of(node: Any) -> Any:
    """Return the Software Bus as a node calls it; an exploration may replace it by a wrapper."""
    return node.cfe.sb


class TopicSide:
    """One side of one node on one topic, which all handles share (rospy.topics._TopicImpl).

    Args:
        node: the node.
        name: resolved name of the topic.
        data_class: message class.

    Attributes:
        is_outside: True if the node is outside of the mission.
        connects_itself: True if a program outside makes its connections, so that publishers wait for it.
    """

    is_outside = connects_itself = False

    def __init__(self, node: Node, name: str, data_class: MessageClass) -> None:
        self.node = node
        self.name = self.resolved_name = name
        self.data_class = data_class
        self.ref_count = 0  # handles
        self.closed = False
        self.topic: TopicEntry | None = None  # None until connected, and if the node is shut down or the types differ
        self._mutex = Mutex(node.kernel, name)
        self._ids: dict[str, int] = {}
        self._bus = bus_of(node)

    @property
    def type(self) -> str:
        """The message type."""
        return str(self.data_class._type)

    @property
    def connections(self) -> list[TopicConnection]:
        """The connections to nodes at the other side."""
        return []

    def connection(self, peer: Node | CompiledNode, direction: str) -> TopicConnection:
        """Return the connection to another node; its number stays the same."""
        name, message = peer.names.name, self.data_class
        number = self._ids.get(name) or self._ids.setdefault(name, next(self.node.connection_numbers))
        endpoint = name if direction == OUTBOUND else str(peer.client.get_node_uri())
        return TopicConnection(number, endpoint, name, direction, self.name, message._type, message._md5sum)

    def get_num_connections(self) -> int:
        """Return the number of connections."""
        return len(self.connections)

    def has_connections(self) -> bool:
        """Return True if any node is at the other side."""
        return self.get_num_connections() > 0

    def has_connection(self, endpoint_id: str) -> bool:
        """Return True if a node is at the other side: a subscriber by its name, a publisher by its URI."""
        return any(each.endpoint_id == endpoint_id for each in self.connections)

    def get_stats_info(self) -> list[tuple[int, str, str, str, str, bool, str]]:
        """Return the data of getBusInfo: number, other side, direction, transport, topic, state, text of each
        connection.
        """
        return [
            (each.id, each.endpoint_id, each.direction, each.transport_type, self.name, True, each.get_transport_info())
            for each in self.connections
        ]

    def acquire(self) -> None:
        """Take the lock that serialises publishing."""
        self._mutex.take()

    def release(self) -> None:
        """Release that lock."""
        self._mutex.give()
