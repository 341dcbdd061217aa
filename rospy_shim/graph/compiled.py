"""Compiled nodes: roscpp nodes that are cFE applications, as the graph knows them.

Such a node reports its publications, subscriptions and services to the application ROS, with a request in the form of a
service request, and gets the MsgId of each name. It asks for parameters in the same way
(`rospy_shim.graph.compiled_params`). It learns everything else from the Software Bus, as on a flight computer without
that application.
"""

from __future__ import annotations

import struct
from collections.abc import Callable, Iterator
from enum import IntEnum
from typing import TYPE_CHECKING, NamedTuple

from cfepy.nodes import ProcessNumbers, process_number
from cfepy.sb import ONESUB_TLM
from cfepy.status import UsageError
from cfepy.units import NS_PER_MS
from rospy_shim.client.service import REQUEST_LEAD, Pieces, answer_packets, call_of_request, room_of
from rospy_shim.graph.compiled_params import CompiledParams
from rospy_shim.graph.msg_ids import COMMAND_BIT
from rospy_shim.parameters.table import MASTER_TLM_MID
from rospy_shim.types.exceptions import ServiceException
from rospy_shim.types.names import ANYTYPE
from rospy_shim.types.transport import HEADER_BYTES, addressed, segments, whole_header

if TYPE_CHECKING:
    from cfepy.sb import SoftwareBus
    from rospy_shim.client.link import Link
    from rospy_shim.graph.graph import Graph, Header, TopicEntry


PIPE_ID_MASK = 0xFFFFFFFF


class Concern(IntEnum):
    """The subject of a request."""

    PUBLISHER = 0
    SUBSCRIBER = 1
    SERVER = 2
    CLIENT = 3
    GONE = 4  # added to the others: ends it
    SUBSCRIBED = 8  # a subscriber's pipe is on the bus now: it wants the latched messages
    ENDED = 32  # the node ends itself; 16 to 31 are about parameters
    TYPE = 33  # the type of a topic's messages


class Enrolled(NamedTuple):
    """The answer to a node about a name."""

    msg_id: int
    raw: bool = False
    latched: bool = False
    pipes: tuple[int, ...] = ()  # that receive the topic, or the requests of the service

    def packed(self) -> bytes:
        """Return the bytes: the MsgId, a byte of flags, and the pipes."""
        return struct.pack(f"<HB{len(self.pipes)}I", self.msg_id, self.raw | self.latched << 1, *self.pipes)


class DeclaredType:
    """A type as a compiled node declares it, without a class.

    Args:
        name: "package/Name"; "*" for any.
        md5sum: md5sum of its definition.
        definition: its full text; empty for a service.
    """

    def __init__(self, name: str, md5sum: str, definition: str) -> None:
        self._type = name
        self._md5sum = md5sum
        self._full_text = definition


class CompiledService:
    """A service that a compiled node offers, for its callers.

    Args:
        node: the node.
        name: resolved name of the service.
        declared: its type.
    """

    def __init__(self, node: CompiledNode, name: str, declared: DeclaredType) -> None:
        self.__node__ = node
        self.resolved_name = name
        self.service_class = declared
        self.uri = f"rosrpc://cfepy:{node.pid}"

    def __has_room__(self, packet: bytes) -> bool:
        """Return True if a packet of a request may be sent."""
        pipe = self.__node__.bus.find_pipe(self.__node__.pipe)
        return pipe is not None and len(pipe.items) < room_of(pipe, packet)

    def __attend__(self) -> None:
        """Do nothing: the node takes its requests when it spins."""

    def shutdown(self, reason: str = "") -> None:
        """Do nothing: another node offers the service now, and this one gets no more calls."""


class _Names(NamedTuple):
    name: str


class _Config(NamedTuple):
    app: str


class _Client(NamedTuple):
    uri: str

    def get_node_uri(self) -> str:
        """Return the URI of the node, where `rospy_shim.master` answers for it."""
        return self.uri


class CompiledNode:
    """A compiled node in the graph.

    Args:
        name: its full name.
        pipe: the pipe through which it receives everything.
        bus: the Software Bus.
        pid: its process number, which is also the port in its URIs.

    Attributes:
        config: holds the name of its application.
        published: types of published topics, by topic.
        subscribed: types of subscribed topics, by topic.
        latched: topics with a latching publisher, in a run that is watched.
    """

    def __init__(self, name: str, pipe: int, bus: SoftwareBus, pid: int) -> None:
        owned = bus.find_pipe(pipe)
        self.names = _Names(name)
        self.config = _Config("" if owned is None else owned.app_name)
        self.kernel = bus.kernel
        self.client = _Client(f"http://cfepy:{pid}/")
        self.pid = pid
        self.pipe = pipe
        self.bus = bus
        self.published: dict[str, str] = {}
        self.subscribed: dict[str, str] = {}
        self.latched: set[str] = set()

    @property
    def is_alive(self) -> bool:
        """True if its application still runs."""
        return self.bus.find_pipe(self.pipe) is not None


class CompiledSender(NamedTuple):
    """The publishing side of a compiled node on a topic, for observers of the bus; it corresponds to a `Link`."""

    node: CompiledNode
    topic: TopicEntry

    @property
    def name(self) -> str:
        """The topic's name."""
        return self.topic.name

    @property
    def msg_id(self) -> int:
        """The topic's MsgId."""
        return self.topic.msg_id

    @property
    def header(self) -> Header:
        """A connection header."""
        return self.topic.compiled_header(self.node)

    def latch(self) -> None:
        """Note that a publisher latches."""
        self.node.latched.add(self.topic.name)


class CompiledNodes:
    """The compiled nodes of a mission, and the application ROS as their master.

    Args:
        graph: the mission's ROS graph.
        bus: the Software Bus.
        ended: takes application and exit status of a node that ends itself; returns the ns until it starts again, or
            None.
        pids: assigns the process numbers.
    """

    def __init__(
        self, graph: Graph, bus: SoftwareBus, ended: Callable[[str, int], int | None], pids: ProcessNumbers
    ) -> None:
        self._graph = graph
        self._bus = bus
        self._ended = ended
        self._pids = pids
        self._params = CompiledParams(graph.params, bus)
        self._pieces = Pieces(REQUEST_LEAD)

    def answer(self, packet: bytes) -> Iterator[bytes]:
        """Return the packets that answer a request; none until the last packet of a long one."""
        number = call_of_request(packet)
        request = self._pieces.add(number, packet)
        if request is None:
            return iter(())
        try:
            good, body = True, self._answer(request)
        except (UsageError, ServiceException, struct.error, ValueError) as error:
            good, body = False, str(error).encode()
        return answer_packets(MASTER_TLM_MID, number, good, body, self._bus.config.sb_max_msg_size)

    def sender(self, app: str, msg_id: int) -> CompiledSender | None:
        """Return the publishing side of an application on the topic with a MsgId; None if it has none."""
        for node in self._graph.compiled.values():
            if node.config.app == app:
                topics = (self._graph.topics[name] for name in node.published if name in self._graph.topics)
                found = next((topic for topic in topics if topic.msg_id == msg_id), None)
                if found is not None:
                    return CompiledSender(node, found)
        return None

    def forget_ended(self) -> None:
        """Remove nodes from the graph whose applications have ended."""
        for node in [each for each in self._graph.compiled.values() if not each.is_alive]:
            del self._graph.compiled[node.names.name]
            self._pids.give(node.pid)
            for name in {**node.published, **node.subscribed}:
                self._graph.topic(name).leave_compiled(node)
            services = self._graph.services
            for name in [name for name, entry in services.items() if entry.service.__node__ is node]:
                del services[name]

    def _answer(self, body: bytes) -> bytes:
        """Handle a request of a node.

        Raises:
            UsageError: the name has no MsgId, or another type, or a parameter's value is invalid.
        """
        pipe, kind = struct.unpack_from("<IB", body)
        who, name, *rest = _texts(body, 5)
        if self._params.takes(kind):
            return self._params.answer(kind, who, name, rest[0])
        if kind == Concern.ENDED:
            return self._end(name, rest[0])
        if kind == Concern.TYPE:
            return self._type_of(name)
        return self._enter(pipe, kind, who, name, DeclaredType(*rest)).packed()

    def _end(self, app: str, status: str) -> bytes:
        """Return whether an application that ends is to start again, and after how many ms."""
        again = self._ended(app, int(status))
        return struct.pack("<BI", again is not None, (again or 0) // NS_PER_MS)

    def _type_of(self, name: str) -> bytes:
        """Return type, md5sum and definition of a topic's messages, and whether a publisher latches, as four texts."""
        topic = self._graph.topic(name)
        latching = "1" if any(link.is_latch for link in topic.links) else "0"
        texts = (topic.type or ANYTYPE, topic.md5sum or ANYTYPE, topic.definition, latching)
        return b"".join(struct.pack("<I", len(each.encode())) + each.encode() for each in texts)

    def _enter(self, pipe: int, kind: int, who: str, name: str, declared: DeclaredType) -> Enrolled:
        self.forget_ended()
        node = self._graph.compiled.get(who)
        if node is None or node.pipe != pipe:
            if node is not None:
                self._pids.give(node.pid)
            node = self._graph.compiled[who] = CompiledNode(who, pipe, self._bus, self._pids.take(process_number(who)))
        does: dict[int, Callable[[CompiledNode, str, DeclaredType], Enrolled]] = {
            Concern.PUBLISHER: self._publish,
            Concern.SUBSCRIBER: self._subscribe,
            Concern.SERVER: self._serve,
            Concern.CLIENT: self._call,
            Concern.PUBLISHER + Concern.GONE: self._publish_no_more,
            Concern.SUBSCRIBER + Concern.GONE: self._subscribe_no_more,
            Concern.SERVER + Concern.GONE: self._serve_no_more,
            Concern.SUBSCRIBER + Concern.SUBSCRIBED: self._give_latched,
        }
        if kind not in does:
            raise UsageError(f"{who} sent an unknown request of kind {kind}; rebuild it with this cfepy")
        return does[kind](node, name, declared)

    def _topic(self, node: CompiledNode, name: str, declared: DeclaredType) -> TopicEntry:
        topic = self._graph.topic(name)
        if not topic.join(declared):
            raise UsageError(
                f"[{node.names.name}] has the type {declared._type} [{declared._md5sum}] for topic {name}, which is"
                f" {topic.type} [{topic.md5sum}] on the graph"
            )
        return topic

    def _publish(self, node: CompiledNode, name: str, declared: DeclaredType) -> Enrolled:
        topic = self._topic(node, name, declared)
        node.published[name] = declared._type
        topic.add_compiled_publisher(node)
        return Enrolled(topic.msg_id, topic.raw, pipes=self._pipes_on(topic.msg_id))

    def _pipes_on(self, msg_id: int) -> tuple[int, ...]:
        """Return the ids of all pipes that receive a MsgId; ids of outlets are cut to their form in packets."""
        route = self._bus.routes.get(msg_id)
        return () if route is None else tuple(each.pipe.pipe_id & PIPE_ID_MASK for each in route.destinations)

    def _publish_no_more(self, node: CompiledNode, name: str, declared: DeclaredType) -> Enrolled:
        topic = self._graph.topic(name)
        if node.published.pop(name, None) is not None:
            topic.leave()
            topic.compiled_publishers.remove(node)
        return Enrolled(topic.msg_id)

    def _subscribe(self, node: CompiledNode, name: str, declared: DeclaredType) -> Enrolled:
        if name in node.subscribed:
            topic = self._graph.topic(name)
        else:
            topic = self._topic(node, name, declared)
            node.subscribed[name] = declared._type
            topic.add_compiled_subscriber(node)
        return Enrolled(topic.msg_id, topic.raw, any(link.is_latch for link in topic.links))

    def _subscribe_no_more(self, node: CompiledNode, name: str, declared: DeclaredType) -> Enrolled:
        topic = self._graph.topic(name)
        if node.subscribed.pop(name, None) is not None:
            topic.leave()
            topic.compiled_subscribers.remove(node)
        return Enrolled(topic.msg_id)

    def _serve(self, node: CompiledNode, name: str, declared: DeclaredType) -> Enrolled:
        return Enrolled(self._graph.register_service(CompiledService(node, name, declared)).answer_id)

    def _serve_no_more(self, node: CompiledNode, name: str, declared: DeclaredType) -> Enrolled:
        entry = self._graph.services.get(name)
        if entry is not None and entry.service.__node__ is node:
            del self._graph.services[name]
        return Enrolled(0)

    def _call(self, node: CompiledNode, name: str, declared: DeclaredType) -> Enrolled:
        answer_id = self._graph.ids.of_service(name)
        return Enrolled(answer_id, pipes=self._pipes_on(answer_id | COMMAND_BIT))

    def _give_latched(self, node: CompiledNode, name: str, declared: DeclaredType) -> Enrolled:
        """Send Python nodes' latched messages to the one subscription that has just come."""
        topic, number = self._graph.topic(name), int(declared._type)
        for link in topic.links:
            if link.is_latch and link.latch is not None and not topic.raw:
                for packet in self._addressed(link, node.pipe, number):
                    self._bus.transmit_msg(packet)
                topic.latched += 1
        return Enrolled(topic.msg_id)

    def _addressed(self, link: Link, pipe: int, number: int) -> Iterator[bytes]:
        payload = link.serialize(link.latch)
        room = self._bus.config.sb_max_msg_size - HEADER_BYTES
        whole = [whole_header(link.msg_id) + payload]
        for packet in whole if len(payload) <= room else segments(link.msg_id, payload, room):
            yield addressed(packet, pipe, number)


def tell_subscription(bus: SoftwareBus, msg_id: int, pipe: int, kind: int) -> None:
    """Notify compiled publishers of a subscription that the Software Bus does not report.

    Args:
        bus: the Software Bus.
        msg_id: MsgId of the topic.
        pipe: the subscribed or unsubscribed pipe, which may be an outlet's.
        kind: SUBSCRIPTION or UNSUBSCRIPTION: the bus reports no end of a subscription, and no subscription of outlets.
    """
    if bus.reporting:
        bus.transmit_msg(ONESUB_TLM.packet(SubType=kind, MsgId=msg_id, Pipe=pipe & PIPE_ID_MASK))


def _texts(body: bytes, count: int) -> list[str]:
    found, at = [], 5
    for _ in range(count):
        (size,) = struct.unpack_from("<I", body, at)
        if at + 4 + size > len(body):
            raise UsageError("a request of a compiled node is truncated")
        found.append(body[at + 4 : at + 4 + size].decode())
        at += 4 + size
    return found
