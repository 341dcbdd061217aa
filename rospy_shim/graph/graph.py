"""The ROS graph of a mission: nodes, topics with their MsgIds, publishers and subscribers (ROS's master).

A topic has one MsgId (`rospy_shim.graph.msg_ids`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from cfepy.interpreter.cached import CachedProperty
from cfepy.sb import SUBSCRIPTION, UNSUBSCRIPTION
from rospy_shim.graph.compiled import CompiledNode, CompiledService, DeclaredType, tell_subscription
from rospy_shim.graph.msg_ids import COMMAND_BIT, MsgIds
from rospy_shim.parameters.tree import ParameterTree
from rospy_shim.types.exceptions import ServiceException
from rospy_shim.types.transport import sequence_of

if TYPE_CHECKING:
    from cfepy.nodes import RosConfig
    from cfepy.rtos import Task
    from cfepy.sb import SoftwareBus
    from rospy_shim.client.link import Link
    from rospy_shim.client.node import Node
    from rospy_shim.client.service import Service
    from rospy_shim.client.subscription import Subscription
    from rospy_shim.types.msgs import MessageClass, ServiceClass

Header = dict[str, str]
"""A connection header of ROS for the two ends of a connection: caller, type, md5sum, topic, ..."""


MOST_NAMES = 1_000
"""Maximum number of publishers, and of subscribers, of a topic in the tables; external tools use a new name at each
start.
"""


class TopicRow(NamedTuple):
    """A topic in the mission's tables.

    `dropped` counts long messages that lost a segment in a full pipe; the bus itself counts the other losses.
    `held_back` counts messages that waited for the board's publishing rate. `definition` is the type's full text.
    `latched` counts messages that were given to one new subscriber alone. `unsent` is true if there were messages
    without a subscriber. `mistyped` has the nodes that are not connected because they have another type, and that type.
    """

    name: str
    msg_id: int
    type: str
    publishers: tuple[str, ...]
    subscribers: tuple[str, ...]
    dropped: int
    held_back: int = 0
    definition: str = ""
    latched: int = 0
    unsent: bool = False
    mistyped: tuple[tuple[str, str], ...] = ()


class TopicEntry:
    """One topic: the MsgId and both sides."""

    def __init__(self, name: str, msg_id: int, raw: bool) -> None:
        self.name = name
        self.msg_id = msg_id
        self.raw = raw
        self.type = ""  # of the first node, as long as there is any node
        self.md5sum = ""
        self.definition = ""
        self._members = 0
        self.links: list[Link] = []
        self.subscriptions: list[Subscription] = []
        self.lagging: list[Subscription] = []  # those whose messages wait in sockets
        self.compiled_publishers: list[CompiledNode] = []
        self.compiled_subscribers: list[CompiledNode] = []
        self.publisher_names: list[str] = []  # all publishers so far, for the tables
        self.subscriber_names: list[str] = []
        self.mistyped: list[tuple[str, str]] = []  # nodes that are not connected, with their type
        self.header: Header | None = None  # of the only publisher; None if a message must be looked up in `notes`
        self._shared = False  # there were two publishers at a time; packets of one that left may still wait in pipes
        self.latching = False
        self.latched = 0  # messages that one new subscriber got after they were published
        self.unsent = False  # whether there were messages without a subscriber
        self.held_back = 0  # messages that waited for the board's publishing rate
        self.lost = 0  # long messages with a missing segment, once per subscriber
        self.notes: dict[int, tuple[Header, int]] = {}  # by sequence count: publisher, and number of the segment

    def join(self, data_class: MessageClass | DeclaredType) -> bool:
        """Connect a node. Returns False if its type differs from the topic's, which the first node decides."""
        if self._members == 0 or not self.type:
            concrete = data_class._type != "*"
            self.type, self.md5sum = (data_class._type, data_class._md5sum) if concrete else (self.type, "")
            self.definition = data_class._full_text if concrete else self.definition
        elif data_class._type != "*" and self.md5sum not in ("", data_class._md5sum):
            return False
        self._members += 1
        return True

    def leave(self) -> None:
        """Disconnect a node that had joined."""
        self._members -= 1

    def add_link(self, link: Link) -> None:
        """Add a publisher."""
        self.links.append(link)
        _remember(self.publisher_names, link.node.names.name)
        self._refresh()
        self._reconnect()

    def remove_link(self, link: Link) -> None:
        """Remove a publisher."""
        if link in self.links:
            self.links.remove(link)
            self._refresh()
            self._reconnect()

    def _reconnect(self) -> None:
        """Let subscribers connect to publishers without a connection, as after a notification of the master."""
        for link in self.links:
            if link.leftovers is not None:
                link.leftovers.reconnect()

    def add_compiled_publisher(self, node: CompiledNode) -> None:
        """Add a compiled publisher; packets that no other publisher has noted are attributed to it."""
        self.compiled_publishers.append(node)
        _remember(self.publisher_names, node.names.name)
        self._shared = True
        self._refresh()

    def add_compiled_subscriber(self, node: CompiledNode) -> None:
        """Add a compiled subscriber."""
        self.compiled_subscribers.append(node)
        _remember(self.subscriber_names, node.names.name)

    def leave_compiled(self, node: CompiledNode) -> None:
        """Remove a compiled node that has ended."""
        for side in (self.compiled_publishers, self.compiled_subscribers):
            if node in side:
                side.remove(node)
                self.leave()

    def add_subscription(self, subscription: Subscription) -> None:
        """Add a subscriber."""
        self.subscriptions.append(subscription)
        _remember(self.subscriber_names, subscription.node.names.name)

    def lags(self, subscription: Subscription) -> None:
        """Let publishers wait for room in the sockets of a subscriber."""
        self.lagging.append(subscription)
        self._refresh_gates()

    def has_caught_up(self, subscription: Subscription) -> None:
        """Let publishers no longer wait for a subscriber."""
        self.lagging.remove(subscription)
        self._refresh_gates()

    def _refresh_gates(self) -> None:
        for link in self.links:
            link.refresh_gate()

    @property
    def queue_size(self) -> int | None:
        """The queue size of the publishers: messages, 0 for no limit, None if one has no queue, so that it waits.

        A packet does not tell its publisher. Of several, the one that drops least counts; compiled nodes count as 1.
        """
        sizes = [each.queue_size for each in self.links]
        if None in sizes:
            return None
        return 0 if 0 in sizes else max((size for size in sizes if size is not None), default=1)

    def remove_subscription(self, subscription: Subscription) -> None:
        """Remove a subscriber."""
        if subscription in self.subscriptions:
            self.subscriptions.remove(subscription)
            for link in self.links:
                link.peer_left(subscription)

    def tell_left(self, bus: SoftwareBus, pipe: int) -> None:
        """Notify compiled publishers that a subscriber's pipe has left the topic."""
        if self.compiled_publishers:
            tell_subscription(bus, self.msg_id, pipe, UNSUBSCRIPTION)

    def tell_came(self, bus: SoftwareBus, pipe: int) -> None:
        """Notify compiled publishers of a new outside subscriber."""
        if self.compiled_publishers:
            tell_subscription(bus, self.msg_id, pipe, SUBSCRIPTION)

    def compiled_header(self, node: CompiledNode) -> Header:
        """Return the connection header of a compiled publisher."""
        about = {"md5sum": self.md5sum, "message_definition": self.definition, "topic": self.name, "type": self.type}
        return {"callerid": node.names.name, "latching": str(int(self.name in node.latched)), **about}

    def _refresh(self) -> None:
        self._shared = shared = self._shared or len(self.links) > 1
        for link in self.links:
            link.shared = shared
        self.header = None if shared else self.links[0].header if self.links else self.header
        self.latching = any(link.is_latch for link in self.links)

    def sender_of(self, packet: bytes) -> Header:
        """Return the connection header of the publisher that sent a packet."""
        if self.header is not None:
            return self.header
        note = self.notes.get(sequence_of(packet))
        if note is not None:
            return note[0]
        one = self.compiled_publishers[0].names.name if len(self.compiled_publishers) == 1 else ""
        return {"callerid": one, "latching": "0", "md5sum": self.md5sum, "topic": self.name, "type": self.type}


class ServiceCall(NamedTuple):
    """A pending service call: the caller's pipe for the answer, and the request's connection header.

    `connection` identifies the connection: all calls of a persistent proxy have the same.
    """

    pipe: int
    header: Header
    connection: object = None


class ServiceEntry:
    """An offered service.

    Args:
        service: handles its requests.
        ids: assigns its MsgIds at their first use.
    """

    def __init__(self, service: Service | CompiledService, ids: MsgIds) -> None:
        self.service = service
        self.calls: dict[int, ServiceCall] = {}  # by number
        self.half_answered: set[int] = set()  # calls whose response could not be serialized
        self.serving: dict[int, tuple[Task, ...]] = {}  # the task that works on a call, by its number
        self.unanswered: set[int] = set()  # calls whose handler ended its thread
        self._ids = ids
        self._count = 0

    @CachedProperty
    def answer_id(self) -> int:
        """MsgId of its answers."""
        return self._ids.of_service(self.service.resolved_name)

    @property
    def request_id(self) -> int:
        """MsgId of its requests: the MsgId of its answers with the command bit."""
        return self.answer_id | COMMAND_BIT

    def begin(self, call: ServiceCall) -> int:
        """Begin a call. Returns its number."""
        self._count = number = self._count + 1
        self.calls[number] = call
        return number


class Graph:
    """All nodes and topics of one mission.

    Args:
        config: the mission file's ROS section.
    """

    def __init__(self, config: RosConfig) -> None:
        self._config = config
        self.connection_delay_ns = config.connection_delay_ns
        self.tells_time = config.bridge.clock_hz > 0  # to nodes outside, on /clock
        self.topics: dict[str, TopicEntry] = {}
        self.nodes: dict[str, Node] = {}
        self.compiled: dict[str, CompiledNode] = {}
        self.services: dict[str, ServiceEntry] = {}
        self.accepted: dict[str, object] = {}  # the newest connection for a service to each node, by its name
        self.displaced: list[tuple[str, str, str]] = []
        self.traps: list[object] = []  # for the report of the run
        """Nodes that gave way to another one: name, the former application, the new one."""
        self.params = ParameterTree(config.params)
        self.ids = MsgIds(config)

    def topic(self, name: str) -> TopicEntry:
        """Return the topic of a resolved name.

        Raises:
            UsageError: its MsgId belongs to another topic.
        """
        topic = self.topics.get(name)
        if topic is None:
            pinned = self._config.topics.get(name)
            topic = self.topics[name] = TopicEntry(name, self.ids.of_topic(name), pinned is not None and pinned.raw)
        return topic

    def register_node(self, node: Node) -> None:
        """Register a node under its name; an earlier node with the same name is shut down, as in ROS."""
        name = node.names.name
        former = self.nodes.get(name)
        self.nodes[name] = node
        if former is not None and former is not node:
            self.displaced.append((name, former.config.app, node.config.app))
            former.give_way()

    def forget_node(self, node: Node) -> None:
        """Remove a node that is gone."""
        if self.nodes.get(node.names.name) is node:
            del self.nodes[node.names.name]

    def register_service(self, service: Service | CompiledService) -> ServiceEntry:
        """Register a service; another node's service of that name is shut down, as ROS forgets it.

        Raises:
            ServiceException: the same node offers it already.
        """
        name = service.resolved_name
        former = self.services.get(name)
        if former is not None and former.service.__node__ is service.__node__:
            raise ServiceException(f"service [{name}] already registered")
        entry = ServiceEntry(service, self.ids)
        if former is not None:
            former.service.shutdown("another node offers the service")
        self.services[name] = entry
        return entry

    def caller(self, name: str) -> tuple[Node, ServiceClass]:
        """Return the node from which a test or a tool can call a service, and the class of the service.

        That is the node that offers it, so that no node has to be added; for a compiled one, any node in Python.

        Args:
            name: resolved name of an offered service.

        Raises:
            ServiceException: a compiled node offers it, and there is no node in Python.
        """
        service = self.services[name].service
        if isinstance(service, CompiledService):
            for node in self.nodes.values():
                return node, node.library.service_class(service.service_class._type)
            raise ServiceException(
                f"service [{name}] of a compiled node can only be called from a node in Python, and none is running"
            )
        return service.__node__, service.service_class

    def forget_service(self, service: Service) -> None:
        """Remove a service."""
        entry = self.services.get(service.resolved_name)
        if entry is not None and entry.service is service:
            del self.services[service.resolved_name]

    def published(self, namespace: str) -> list[list[str]]:
        """Return [name, type] of the published topics below a namespace."""
        if not isinstance(namespace, str):  # as XML-RPC brings it: an empty list means all, bytes are no text
            namespace = "" if not namespace else "\0"
        prefix = namespace.rstrip("/") + "/"
        return [
            [topic.name, topic.type] for topic in self.topics.values() if topic.links and topic.name.startswith(prefix)
        ]


def _remember(names: list[str], name: str) -> None:
    if len(names) < MOST_NAMES and name not in names:
        names.append(name)
