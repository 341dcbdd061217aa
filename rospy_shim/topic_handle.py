"""What publishers and subscribers have in common: the handle that a node holds (rospy.topics.Topic), and the side of
the topic that a node's handles share. May import cfepy.rtos.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, ClassVar, NamedTuple, cast

from cfepy.rtos import Mutex
from rospy_shim.names import is_legal_name

if TYPE_CHECKING:
    from rospy_shim.graph import Topic
    from rospy_shim.node import Node

INBOUND, OUTBOUND, BIDIRECTIONAL = "i", "o", "b"  # rospy.impl.transport


class Connection(NamedTuple):
    """A node at the other side, under the names by which libraries such as actionlib look for it."""

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
        """What rosnode prints of a connection."""
        return f"TCPROS connection on port {self.id} to [cfepy:{self.id} on socket {self.id}]"


class TopicSide:
    """One side of one node on one topic, which all handles share (rospy.topics._TopicImpl).

    Args:
        node: the node.
        name: resolved name of the topic.
        data_class: message class.
    """

    def __init__(self, node: Node, name: str, data_class: Any) -> None:
        self.node = node
        self.name = self.resolved_name = name
        self.data_class = data_class
        self.ref_count = 0  # handles
        self.closed = False
        self.topic: Topic | None = None  # None until connected, and when the node is shut down or the types differ
        self._mutex = Mutex(node.kernel, name)
        self._ids: dict[str, int] = {}

    @property
    def type(self) -> str:
        """The message type."""
        return str(self.data_class._type)

    @property
    def connections(self) -> list[Connection]:
        """The nodes at the other side."""
        return []

    def connection(self, peer: Node, direction: str) -> Connection:
        """The connection to another node; its number stays the same."""
        name, message = peer.names.name, self.data_class
        number = self._ids.get(name) or self._ids.setdefault(name, next(self.node.connection_numbers))
        endpoint = name if direction == OUTBOUND else str(peer.client.get_node_uri())
        return Connection(number, endpoint, name, direction, self.name, message._type, message._md5sum)

    def get_num_connections(self) -> int:
        """How many are at the other side."""
        return len(self.connections)

    def has_connections(self) -> bool:
        """Whether anybody is at the other side."""
        return self.get_num_connections() > 0

    def has_connection(self, endpoint_id: str) -> bool:
        """Whether somebody is at the other side: a subscriber by its name, a publisher by its URI."""
        return any(each.endpoint_id == endpoint_id for each in self.connections)

    def get_stats_info(self) -> list[tuple[int, str, str, str, str, bool, str]]:
        """The connections as getBusInfo gives them: number, other side, direction, transport, topic, state, text."""
        return [
            (each.id, each.endpoint_id, each.direction, each.transport_type, self.name, True, each.get_transport_info())
            for each in self.connections
        ]

    def acquire(self) -> None:
        """Take the lock that serialises publishing."""
        self._mutex.take()

    def release(self) -> None:
        """Give that lock back."""
        self._mutex.give()


class TopicHandle:
    """A topic as one side of a node sees it; `impl` is shared by all handles of the side, None once unregistered."""

    __module__ = "rospy.topics"
    _node: ClassVar[Node]
    impl: Any = None

    def __init__(self, name: str, data_class: Any, reg_type: str) -> None:
        """Check the arguments and resolve the name.

        Raises:
            ValueError: an empty name, a class that is no message class, or a private name before `init_node`.
        """
        if not name or not isinstance(name, str):
            raise ValueError("topic name is not a non-empty string")
        if data_class is None:
            raise ValueError("topic parameter 'data_class' is not initialized")
        if not isinstance(data_class, type):
            raise ValueError(f"data_class [{data_class}] is not a class")
        if not hasattr(data_class, "_md5sum"):
            raise ValueError(f"data_class [{type(data_class).__name__}] is not a message data class")
        node = self._node
        if not is_legal_name(name):
            node.warn_of_illegal(name)
        names = node.names
        if node.initialized:
            self.resolved_name = names.resolve_name(name)
        else:
            self.resolved_name = names.resolve_name_without_node_name(name)
        self.name = self.resolved_name
        self.data_class = message = cast(Any, data_class)
        self.type: str = message._type
        self.md5sum: str = message._md5sum
        self.reg_type = reg_type

    def get_num_connections(self) -> int:
        """How many are at the other side."""
        self._node.universe.charge()
        return self.impl.get_num_connections() if self.impl is not None else 0
