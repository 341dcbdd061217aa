"""ROS nodes outside of the mission, as its graph sees them: with publishers, subscribers and services like all others.

`OutsideGraph` is what programs on this computer do to the graph, in plain values, so that a journal has all of it and a
replay does it again (`cfepy.mission.acts`). What the mission has for them goes to `OutsideGraph.way_out`; a replay has
none. Nothing here waits for them: a message for an outside subscriber is handed on at once.
"""

from __future__ import annotations

from collections.abc import Callable
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any, Protocol
from xmlrpc.client import loads

from cfepy.sb import Outlet
from cfepy.status import CfeError
from rospy_shim.client.exceptions import ServiceException
from rospy_shim.client.link import Link
from rospy_shim.client.service import (
    ANSWER_LEAD,
    REQUEST_LEAD,
    Pieces,
    answer_packets,
    call_of_answer,
    call_of_request,
    request_packets,
)
from rospy_shim.client.subscription import NO_PIPE, Subscription
from rospy_shim.client.transport import (
    EVERYBODY,
    HEADER_BYTES,
    SPARE_AT,
    WHOLE,
    Assembler,
    is_for_another,
    segments,
    sequence_of,
    whole_header,
)
from rospy_shim.graph.compiled import CompiledService, DeclaredType
from rospy_shim.graph.graph import ServiceCall
from rospy_shim.master.calls import call

if TYPE_CHECKING:
    from cfepy.app import Cfe
    from cfepy.rtos import Kernel
    from cfepy.sb import Pipe
    from rospy_shim.graph.graph import Graph, Header, ServiceEntry, TopicEntry
    from rospy_shim.master import Switchboard
    from rospy_shim.master.calls import Answer

PACE_NS = 100_000  # between two looks whether a service has room for the next packet of a request
PRIORITY = 100  # of a task that calls a compiled node's service, as a node's


class WayOut(Protocol):
    """What takes things out of the mission. It is called in the mission's tasks, and must not wait."""

    def message(self, topic: str, publisher: str, subscriber: str, payload: bytes) -> None:
        """A message for an outside subscriber. `publisher` is "" for one that no ROS node has sent."""

    def packet(self, topic: str, packet: bytes) -> None:
        """A packet of cFE applications that is shown as a topic."""

    def request(self, service: str, number: int, header: Header, body: bytes) -> None:
        """A request for an outside service; `number` is that of the call."""

    def answer(self, number: int, good: bool, body: bytes) -> None:
        """The answer to a call from outside: the serialised response, or an error's text."""


class OutsideNode:
    """A node outside of the mission, as the two sides of a topic see theirs.

    Args:
        name: its full name.
        uri: where it answers.
        graph: the mission's ROS graph.
        cfe: the services.
        kernel: the simulated computer's.
    """

    call_ns = publish_slot_ns = pid = 0
    owner = None
    config = SimpleNamespace(app="host")  # in whose name its messages are sent, as the watches of the bus see it

    def __init__(self, name: str, uri: str, graph: Graph, cfe: Cfe, kernel: Kernel) -> None:
        self.names = SimpleNamespace(name=name)
        self.uri = uri
        self.client = SimpleNamespace(get_node_uri=lambda: self.uri)
        self.graph = graph
        self.cfe = cfe
        self.kernel = kernel

    def working(self, name: str, unpack: Any) -> Any:
        """Its callbacks take none of the mission's time."""
        return unpack


class OutsideLink(Link):
    """The publishing side of an outside node: what came from it is sent on the bus.

    Args:
        node: the publisher.
        topic: the topic, which it has joined.
        declared: type of the messages.
        latching: it latches.
    """

    is_outside = True

    def __init__(self, node: OutsideNode, topic: TopicEntry, declared: DeclaredType, latching: bool) -> None:
        as_node: Any = node
        as_class: Any = declared
        super().__init__(as_node, topic.name, as_class)
        self.topic = topic
        self.raw = topic.raw
        self.msg_id = topic.msg_id
        self.is_latch = latching
        self.header |= self._own_header()
        topic.add_link(self)

    def close(self) -> None:
        """Leave the graph."""
        self.closed = True
        self._routes = {}
        if self.topic is not None:
            self.topic.remove_link(self)
            self.topic.leave()
            self.topic = None

    def has_room(self, payload: bytes) -> bool:
        """Whether the bus and every subscriber take a message now, or drop an older one for it.

        One whose queue is longer than a pipe can be drops none: what the pipe does not hold can wait outside.
        """
        count = -(-len(payload) // self._room) or 1
        route = self._routes.get(self.msg_id)
        return route is None or (
            self._bus.has_room(payload) and all(self._takes(each.pipe, count) for each in route.active)
        )

    def _takes(self, pipe: Pipe, count: int) -> bool:
        if len(pipe.items) + count <= pipe.depth:
            return True
        drops = pipe.keeps_newest and count <= pipe.depth
        return drops and not any(each.is_cut_short(pipe) for each in self.peers)

    def enter(self, payload: bytes) -> bool:
        """A message came; False when the bus did not take it."""
        self.seq += 1
        self.message_data_sent += len(payload)
        if self.is_latch:
            self.latch = payload
        route = self._routes.get(self.msg_id)
        if self.topic is None or route is None or not route.active:
            return True
        try:
            packets = self._packets(payload)
            if self.raw and int.from_bytes(packets[0][:2], "big") != self.msg_id:
                return False
            for index, packet in enumerate(packets):
                self._note(index)
                self._bus.transmit_msg(packet)
        except CfeError:
            return False
        return True

    def _packets(self, payload: bytes) -> list[bytes]:
        if self.raw:
            return [payload[12:]]  # behind the fields of an empty layout and the length of the data
        if len(payload) <= self._room:
            return [whole_header(self.msg_id) + payload]
        packets = list(segments(self.msg_id, payload, self._room))
        for subscription in self.peers:
            subscription.expect_segments(len(packets))
        return packets

    def serialize(self, message: Any) -> bytes:
        """A latched message, which is kept as it came."""
        return bytes(message)

    def give_latched(self, subscription: Subscription) -> None:
        """See `Link.give_latched`; another outside node is connected with the publisher itself."""
        if self.is_latch and self.latch is not None and not self.raw and not subscription.is_outside:
            subscription.deliver(self.latch, self.header)
            if self.topic is not None:
                self.topic.latched += 1


class OutsideSubscription(Subscription):
    """The subscribing side of an outside node: what it hears goes out.

    Args:
        node: the subscriber.
        topic: the topic, which it has joined.
        declared: type that it wants.
        outsiders: says whether a message comes from an outside node that has sent it to this one already.
        out: takes publisher and message.
    """

    is_outside = True

    def __init__(
        self,
        node: OutsideNode,
        topic: TopicEntry,
        declared: DeclaredType,
        outsiders: Callable[[], bool],
        out: Callable[[str, bytes], object],
    ) -> None:
        as_node: Any = node
        as_class: Any = declared
        super().__init__(as_node, topic.name, as_class)
        self.topic = topic
        self.has_begun = True
        self.publishers: list[str] = []  # with which it is connected
        self._outsiders = outsiders
        self._out = out
        self._raw = topic.raw
        self._together = Assembler()
        self._outlet = Outlet(node.cfe.sb, topic.msg_id, f"{node.names.name}{topic.name}", self._take)
        topic.add_subscription(self)
        topic.tell_came(node.cfe.sb, self._outlet.pipe_id)

    def expect_segments(self, count: int) -> None:
        """Nothing waits here."""

    def ignore(self, link: Link) -> None:
        """See `Subscription.ignore`."""
        self._outlet.ignore(link.node.owner)

    def heed(self, link: Link) -> None:
        """See `Subscription.heed`."""
        self._outlet.heed(link.node.owner)

    def deliver(self, payload: bytes, header: Header) -> None:
        """See `Subscription.deliver`."""
        self._out(header["callerid"], payload)

    def close(self) -> None:
        """Leave the graph."""
        if self.topic is not None:
            self.topic.remove_subscription(self)
            self.topic.leave()
            self.topic.tell_left(self.node.cfe.sb, self._outlet.pipe_id)
            self.topic = None
            self._outlet.close()

    def _take(self, packet: bytes) -> None:
        topic = self.topic
        if topic is None or self._outsiders():
            return
        if self._raw:
            self._out(topic.sender_of(packet)["callerid"], bytes(8) + len(packet).to_bytes(4, "little") + packet)
            return
        if packet[SPARE_AT:HEADER_BYTES] != EVERYBODY and is_for_another(packet, self._outlet.pipe_id):
            return
        whole: bytes | None = packet
        if packet[2] < WHOLE:
            header, index = topic.notes.get(sequence_of(packet), (None, None))
            whole = self._together.add(packet, header["callerid"] if header is not None else "", index)
        if whole is not None:
            self._out(topic.sender_of(packet)["callerid"], whole[HEADER_BYTES:])


class OutsideService(CompiledService):
    """A service that an outside node offers.

    Args:
        node: which one.
        name: resolved name of the service.
        declared: its type.
        uri: where it is called, rosrpc://HOST:PORT.
        open_outlet: makes what takes its requests; a service that nobody calls needs no MsgId.
    """

    def __init__(
        self,
        node: OutsideNode,
        name: str,
        declared: DeclaredType,
        uri: str,
        open_outlet: Callable[[], Outlet],
    ) -> None:
        as_node: Any = node
        super().__init__(as_node, name, declared)
        self.uri = uri
        self._open = open_outlet
        self._outlet: Outlet | None = None

    def has_room(self, packet: bytes) -> bool:
        """A request goes out at once."""
        if self._outlet is None:
            self._outlet = self._open()
        return True

    def close(self) -> None:
        """It is called no more."""
        if self._outlet is not None:
            self._outlet.close()


class OutsideGraph:
    """What outside nodes do to the graph of a mission.

    Args:
        graph: the graph.
        switchboard: finds the master and the nodes of the mission.
        cfe: the services.
        kernel: the simulated computer's.

    Attributes:
        nodes, links, subscriptions, services: what outside nodes have in the graph.
        way_out: takes what goes out; None drops it.
        ways_out: takes what goes out to nodes with a way of their own, by their names. Those of one way reach each
            other without the mission.
    """

    def __init__(self, graph: Graph, switchboard: Switchboard, cfe: Cfe, kernel: Kernel) -> None:
        self.way_out: WayOut | None = None
        self.ways_out: dict[str, WayOut] = {}
        self.nodes: dict[str, OutsideNode] = {}
        self.links: dict[tuple[str, str], OutsideLink] = {}  # by topic and node
        self.subscriptions: dict[tuple[str, str], OutsideSubscription] = {}
        self.services: dict[str, OutsideService] = {}
        self._graph = graph
        self._switchboard = switchboard
        self._cfe = cfe
        self._kernel = kernel
        self._entering = ""  # the outside node of which a message comes in
        self._pieces: dict[str, Pieces] = {}  # of long requests, by service
        self._calls: dict[str, dict[int, tuple[int, str]]] = {}  # by service and its number: caller's number, caller
        self._outlets: dict[str, Outlet] = {}  # by service
        self._shown: dict[str, Outlet] = {}  # by topic
        self._acts: dict[str, Callable[..., Any]] = {
            "ask": self._ask,
            "publish": self._publish,
            "publish no more": self._publish_no_more,
            "message": self._message,
            "subscribe": self._subscribe,
            "subscribe no more": self._subscribe_no_more,
            "show": self._show,
            "show no more": self._show_no_more,
            "call": self._call,
            "forget call": self._forget_call,
            "serve": self._serve,
            "serve no more": self._serve_no_more,
            "answer": self._answer,
        }

    def do(self, name: str, *values: Any) -> Any:
        """Do one thing; names and values are those of the methods below.

        Raises:
            KeyError: there is no such thing, topic, node or service.
            UsageError: a topic's MsgId belongs to another topic.
            CfeError: the bus is full.
        """
        return self._acts[name](*values)

    # -- the master --------------------------------------------------------------------------------------------------

    def _ask(self, node: str, body: bytes) -> Answer:
        """A request that changes something, as XML-RPC carries it; the answer.

        Args:
            node: a node of the mission, which is asked; "" for the master.
            body: method and arguments.
        """
        arguments, method = loads(body, use_builtin_types=True)
        api = self._switchboard.api_of(node) if node else self._switchboard.master
        if api is None:
            return 0, f"[{node}] is no node of the mission", 0
        return call(api, str(method), arguments)

    # -- topics ------------------------------------------------------------------------------------------------------

    def _node(self, name: str, uri: str) -> OutsideNode:
        node = self.nodes.get(name)
        if node is None:
            node = self.nodes[name] = OutsideNode(name, uri, self._graph, self._cfe, self._kernel)
        node.uri = uri or node.uri
        return node

    def _publish(self, topic: str, name: str, uri: str, kind: str, md5sum: str, definition: str, latching: bool) -> str:
        """The mission is connected with an outside publisher; "" when it is, else why not."""
        entry, declared = self._graph.topic(topic), DeclaredType(kind, md5sum, definition)
        self._publish_no_more(topic, name)
        if not entry.join(declared):
            return f"it is {kind} [{md5sum}] there and {entry.type} [{entry.md5sum}] here"
        self.links[topic, name] = OutsideLink(self._node(name, uri), entry, declared, latching)
        return ""

    def _publish_no_more(self, topic: str, name: str) -> None:
        link = self.links.pop((topic, name), None)
        if link is not None:
            link.close()

    def _message(self, topic: str, name: str, payload: bytes) -> bool:
        """A message from an outside publisher; whether the bus took it."""
        self._entering = name
        try:
            return self.links[topic, name].enter(payload)
        finally:
            self._entering = ""

    def _subscribe(self, topic: str, name: str, uri: str, kind: str, md5sum: str, publisher: str) -> str:
        """An outside subscriber is connected with a node of the mission, "" for its cFE applications; why not."""
        entry = self._graph.topic(topic)
        subscription = self.subscriptions.get((topic, name))
        if subscription is None:
            declared = DeclaredType("*" if "*" in (kind, md5sum) else kind, md5sum, "")
            if not entry.join(declared):
                return f"it is {kind} [{md5sum}] there and {entry.type} [{entry.md5sum}] here"
            subscription = OutsideSubscription(
                self._node(name, uri), entry, declared, lambda: self._reaches(name), self._out_to(topic, name)
            )
            self.subscriptions[topic, name] = subscription
            for each in entry.links:
                if not each.is_outside:  # what comes from there comes at once
                    each.expect_peer(subscription)
        subscription.publishers.append(publisher)
        node = self._graph.nodes.get(publisher)
        link = None if node is None else node.links.get(topic)
        if link is not None:
            if subscription in link.expected:
                link.peer_connected(subscription)
            link.peer_joined(subscription, late=True)
        else:
            self._give_latched(topic, publisher, subscription)
        return ""

    def _give_latched(self, topic: str, publisher: str, subscription: OutsideSubscription) -> None:
        """An outside subscriber has another way than an outside publisher: what that has latched comes from here."""
        link = self.links.get((topic, publisher))
        if link is None or self._way_to(publisher) is self._way_to(subscription.node.names.name):
            return
        if link.is_latch and link.latch is not None and not link.raw:
            subscription.deliver(link.latch, link.header)

    def _way_to(self, name: str) -> WayOut | None:
        """The way out to an outside node."""
        return self.ways_out.get(name, self.way_out)

    def _reaches(self, name: str) -> bool:
        """Whether the publisher of which a message comes in reaches an outside node by itself."""
        return self._entering != "" and self._way_to(self._entering) is self._way_to(name)

    def _out_to(self, topic: str, subscriber: str) -> Callable[[str, bytes], None]:
        def out(publisher: str, payload: bytes) -> None:
            way = self._way_to(subscriber)
            if way is not None:
                way.message(topic, publisher, subscriber, payload)

        return out

    def _subscribe_no_more(self, topic: str, name: str, publisher: str) -> None:
        """One of its connections is gone; with the last one the subscriber is."""
        subscription = self.subscriptions.get((topic, name))
        if subscription is None:
            return
        if publisher in subscription.publishers:
            subscription.publishers.remove(publisher)
        if not subscription.publishers:
            del self.subscriptions[topic, name]
            subscription.close()

    def _show(self, topic: str, msg_id: int) -> None:
        """Somebody outside hears packets of cFE applications."""
        if topic not in self._shown:

            def take(packet: bytes) -> None:
                if self.way_out is not None:
                    self.way_out.packet(topic, packet)

            self._shown[topic] = Outlet(self._cfe.sb, msg_id, topic, take)

    def _show_no_more(self, topic: str) -> None:
        outlet = self._shown.pop(topic, None)
        if outlet is not None:
            outlet.close()

    # -- services of the mission -------------------------------------------------------------------------------------

    def _call(self, service: str, number: int, caller: str, body: bytes) -> None:
        """An outside node calls a service of the mission.

        Raises:
            KeyError: there is none of that name.
        """
        entry = self._graph.services[service]
        header = {"callerid": caller, "md5sum": entry.service.service_class._md5sum, "service": service}
        self._listen(service, entry)
        inner = entry.begin(ServiceCall(NO_PIPE, header))
        self._calls[service][inner] = (number, caller)
        packets = list(request_packets(entry.request_id, inner, body, self._cfe.sb.config.sb_max_msg_size))

        def send() -> None:
            for packet in packets:
                while not entry.service.has_room(packet):
                    if self._graph.services.get(service) is not entry:
                        return
                    entry.service.attend()
                    self._kernel.delay(PACE_NS)
                self._cfe.sb.transmit_msg(packet)
                entry.service.attend()

        if all(entry.service.has_room(packet) for packet in packets):
            send()
            return
        node = self._graph.nodes.get(entry.service.node.names.name)
        if node is not None:
            node.start_task("host", send)
        else:
            self._kernel.spawn(f"call of {service}", send, PRIORITY)

    def _listen(self, service: str, entry: ServiceEntry) -> None:
        """Hear the answers of a service of the mission."""
        outlet = self._outlets.get(service)
        if outlet is None:
            self._calls[service] = {}
            pieces = Pieces(ANSWER_LEAD)

            def take(packet: bytes) -> None:
                inner, good = call_of_answer(packet)
                outer = self._calls[service].get(inner)
                body = None if outer is None else pieces.add(inner, packet)
                if outer is not None and body is not None:
                    del self._calls[service][inner]
                    current = self._graph.services.get(service)
                    if current is not None:
                        current.calls.pop(inner, None)
                        current.half_answered.discard(inner)
                    number, caller = outer
                    way = self._way_to(caller)
                    if way is not None:
                        way.answer(number, good, body)

            self._outlets[service] = Outlet(self._cfe.sb, entry.answer_id, f"answers of {service}", take)

    def _forget_call(self, service: str, number: int, caller: str) -> None:
        """The caller does not wait for the answer any more."""
        calls = self._calls.get(service, {})
        for inner in [each for each, outer in calls.items() if outer == (number, caller)]:
            del calls[inner]

    # -- services of outside nodes -----------------------------------------------------------------------------------

    def _serve(self, service: str, name: str, uri: str, address: str, kind: str, md5sum: str) -> bool:
        """An outside node offers a service; False when the mission has one of that name."""
        former = self._graph.services.get(service)
        if former is not None and not isinstance(former.service, OutsideService):
            return False
        self._serve_no_more(service)
        made = OutsideService(
            self._node(name, uri),
            service,
            DeclaredType(kind, md5sum, ""),
            address,
            lambda: self._hear_requests(service),
        )
        try:
            self._graph.register_service(made)
        except ServiceException:
            return False
        self.services[service] = made
        return True

    def _hear_requests(self, service: str) -> Outlet:
        entry, pieces = self._graph.services[service], Pieces(REQUEST_LEAD)

        def take(packet: bytes) -> None:
            number = call_of_request(packet)
            body = pieces.add(number, packet)
            way = self._way_to(entry.service.node.names.name)
            if body is not None and way is not None:
                way.request(service, number, entry.calls[number].header, body)

        return Outlet(self._cfe.sb, entry.request_id, f"requests to {service}", take)

    def _serve_no_more(self, service: str) -> None:
        made = self.services.pop(service, None)
        if made is not None:
            made.close()
            entry = self._graph.services.get(service)
            if entry is not None and entry.service is made:
                del self._graph.services[service]

    def _answer(self, service: str, number: int, good: bool, body: bytes) -> bool:
        """The answer of an outside service; False when nobody waits for it."""
        entry = self._graph.services.get(service)
        if entry is None or number not in entry.calls:
            return False
        try:
            for packet in answer_packets(entry.answer_id, number, good, body, self._cfe.sb.config.sb_max_msg_size):
                self._cfe.sb.transmit_msg(packet)
        except CfeError:
            return False
        return True
