"""`RosHost`: joins a paced mission to ROS on this computer.

The mission's nodes get addresses, external programs get a place in its graph, and messages, requests and answers pass
between them. All input enters through `cfepy.mission.outside` as host actions, while the run stands still between two
steps. So a journal records it, and a replay needs none of this. Output of the mission is sent at once, into sockets
that never block. The world (`cfepy.extra.ros_host.world`) knows the external nodes and the state of the master.
"""

from __future__ import annotations

import os
import struct
import time
from collections import deque
from collections.abc import Callable, Mapping
from selectors import EVENT_READ, DefaultSelector
from typing import TYPE_CHECKING, Any
from xmlrpc.client import dumps

from cfepy.extra.ros_host.errands import Errands
from cfepy.extra.ros_host.joint import RosAddress
from cfepy.extra.ros_host.mission_node import ANY, MissionNode, OutsideClient
from cfepy.extra.ros_host.peers import OutsideCall, OutsidePublisher
from cfepy.extra.ros_host.tcpros import frame
from cfepy.extra.ros_host.world import OwnGraph, RosWorld
from cfepy.extra.ros_host.xmlrpc_server import ServerBounds
from cfepy.ground import APPLICATIONS, CLOCK, TOO_SHORT, ShownPackets
from cfepy.io import OUT_OF, InputRoom, InputTurn, OwnNames, PeerCounts, PeerPlaces
from cfepy.mission import Mission
from cfepy.reading.input_limits import ROS_PUBLISHERS
from cfepy.status import CfeError, UsageError
from cfepy.units import NS_PER_S
from rospy_shim.master.xmlrpc_calls import Answer

if TYPE_CHECKING:
    from rospy_shim.graph.outside import OutsideGraph
    from rospy_shim.runtime import RosRuntime

LOOPBACK = "127.0.0.1"
LOOK_S = 0.02  # wall time between two looks at new and lost nodes
PUT_OFF_S = 0.1  # maximum delay of a look while input arrives
ACT = "ros"
TABLE = "ros_peers"
_time = struct.Struct("<II").pack


def address_of(environ: Mapping[str, str]) -> RosAddress:
    """Return the address of the mission's nodes, from ROS_HOSTNAME or ROS_IP (wiki.ros.org/ROS/NetworkSetup).

    Without them the nodes are reachable only from this computer.
    """
    host = environ.get("ROS_HOSTNAME") or environ.get("ROS_IP") or LOOPBACK
    return RosAddress(host, LOOPBACK if host == "localhost" or host.startswith("127.") else "")


class RosHost:
    """Joins a mission to ROS. Use as a context manager around the run.

    Args:
        mission: the mission, which stands at virtual time 0.
        make_world: makes the world: a master that is served here, or a running one that the mission joins.
        environ: environment of this process; it sets the address of the mission's nodes (`address_of`).
        tell: receives messages for the user.

    Raises:
        UsageError: the master cannot be reached, or its port is taken.
    """

    def __init__(
        self,
        mission: Mission,
        make_world: Callable[[RosHost], RosWorld],
        environ: Mapping[str, str] = os.environ,
        tell: Callable[[str], object] = lambda line: None,
    ) -> None:
        self.selector = DefaultSelector()
        self.address = address_of(environ)
        self.errands = Errands(tell)
        self.counts = PeerCounts()
        names = OwnNames(filter(None, (environ.get("ROS_HOSTNAME"), environ.get("ROS_IP"))))
        self.bounds = ServerBounds(
            names, PeerPlaces(), InputRoom(), InputTurn(), deque(), self.errands.nudge, self.now_s
        )
        self.pid = os.getpid()
        self.tell = tell
        self.ros: RosRuntime | None = None
        self.seen = OwnGraph({}, [], [], [], {}, {})
        self._mission = mission
        self._outside: OutsideGraph | None = None
        self._nodes: dict[str, MissionNode] = {}
        self._outer: dict[str, str] = {}  # URIs outside by those in the mission
        self._publishers: dict[tuple[str, str], OutsidePublisher] = {}  # by topic and URI
        self._clients: dict[
            tuple[str, str], dict[str, list[OutsideClient]]
        ] = {}  # by topic and subscriber, then publisher
        self._calls: dict[int, tuple[str, OutsideClient]] = {}
        self._last_call = 0
        self._offered: dict[str, tuple[str, str]] = {}  # outside services: node and URI, probed or being probed
        self._todo: list[Callable[[], object]] = []
        self.stalled: set[OutsidePublisher] = set()  # whose messages wait for room
        self._params: list[str] = []  # changed parameters
        self._look_at_s = 0.0
        self._is_over = False
        self.selector.register(self.errands, EVENT_READ, lambda events: self.errands.deliver())
        self.shown = ShownPackets(mission)
        self._ears: dict[str, list[OutsideClient]] = {}  # by topic, of shown packets and /clock
        self._tell_at_ns = 0
        mission.record.tables[TABLE] = self.counts.rows
        self.world = make_world(self)
        self.world.begin()

    def __enter__(self) -> RosHost:
        return self

    def __exit__(self, *error: object) -> None:
        self.close()

    def fileno(self) -> int:
        """Return the descriptor that becomes readable when input arrives."""
        return self.selector.fileno()

    def now_s(self) -> float:
        """Return wall time in s since an arbitrary instant."""
        return time.monotonic()

    def exchange(self) -> None:
        """Bring in the input that arrived, and look for new and lost nodes."""
        if self._mission.ros is not self.ros or self.ros is None:
            self._begin()
        self.bounds.turn.begin()
        for _ in range(len(self.bounds.late)):
            self.bounds.late.popleft().go_on()
        todo, self._todo = self._todo, []
        for each in todo:
            each()
        for publisher in list(self.stalled):
            publisher.enter()
        arrived = self.selector.select(0)
        for key, events in arrived:
            key.data(events)
        now_s = self.now_s()
        if now_s >= self._look_at_s + (PUT_OFF_S if arrived else 0.0):  # input that arrived goes first
            self._look_at_s = now_s + LOOK_S
            self._look(now_s)
        if self.shown.clock_ns:
            self._tell_time()

    def soon(self) -> None:
        """Look for new and lost nodes at the next opportunity."""
        self._look_at_s = 0.0

    def close(self) -> None:
        """Leave ROS, and close everything."""
        self._is_over = True
        self.world.close()
        self._close_all()
        self.errands.close()
        self.selector.close()
        if self._outside is not None:
            self._outside.way_out = None

    # -- the mission -------------------------------------------------------------------------------------------------

    def act(self, name: str, *values: Any) -> Any:
        """Perform a host action on the mission's graph (`OutsideGraph.do`); a journal records it."""
        if self._is_over:
            return ""
        return self._mission.outside.act(ACT, name, *values)

    def ask_inside(self, node: str, body: bytes) -> Answer:
        """Send a changing request of the master or slave API to the mission; `node` is "" for the master."""
        try:
            answer: Answer = self.act("ask", node, body)
        except CfeError as error:
            return 0, str(error), 0
        return self.outer_answer(answer)

    def _begin(self) -> None:
        """Begin with a new ROS side of the processor: it has none of the external entries of the former graph."""
        self._mission.outside.act(ACT)
        ros = self._mission.ros
        assert ros is not None
        self.ros, self._outside = ros, ros.outside
        ros.outside.way_out = self
        ros.graph.params.on_change(self._params.append)
        self._close_all()
        self.world.enter()
        if self.shown:
            self._register_applications()

    def _register_applications(self) -> None:
        """Register one node that stands for the cFE applications; the mission's own graph has only its name."""
        node = self._nodes[APPLICATIONS] = MissionNode(self, APPLICATIONS, "")
        node.inner = node.uri
        for topic, kind in self.shown.types.items():
            self.ask_inside("", dumps((APPLICATIONS, topic, kind.name, node.uri), "registerPublisher").encode())
        for topic in self.shown.heard:
            self.ask_inside("", dumps((APPLICATIONS, topic, ANY, node.uri), "registerSubscriber").encode())

    def _close_all(self) -> None:
        for publisher in self._publishers.values():
            publisher.close()
        for node in self._nodes.values():
            node.close()
        for each in (self._publishers, self._nodes, self._clients, self._ears, self._calls, self._offered):
            each.clear()

    def see(self) -> OwnGraph:
        """Update the mission's own part of the graph; new nodes have their addresses afterwards."""
        assert self.ros is not None
        graph, registry = self.ros.graph, self.ros.switchboard.master.registry
        nodes = {name: registry.node_uri(name) or "" for name in (*graph.nodes, *graph.compiled)}
        others = {name: registry.node_uri(name) for name in self.ros.outside.ways_out}  # such as of a viewer's server
        nodes |= {name: uri for name, uri in others.items() if uri is not None}
        if self.shown:
            nodes[APPLICATIONS] = self._nodes[APPLICATIONS].inner
        publishers = _own(registry.publishers(), nodes)
        subscribers = _own(registry.subscribers(), nodes)
        services = _own(registry.providers(), nodes)
        subscribed: dict[str, str] = {}
        for topic, name in subscribers:
            subscribed.setdefault(topic, name)
        self.seen = OwnGraph(nodes, publishers, subscribers, services, registry.topic_types(), subscribed)
        for name in [each for each, node in self._nodes.items() if nodes.get(each) != node.inner]:
            self._nodes.pop(name).close()
        for name, inner in nodes.items():
            if name not in self._nodes:
                self._nodes[name] = MissionNode(self, name, inner)
        self._outer = {node.inner: node.uri for node in self._nodes.values()}
        for service, name in services:
            self._outer[registry.service_uri(service) or ""] = self._nodes[name].service_uri
        return self.seen

    def node_uri(self, name: str) -> str:
        """Return the external URI of a node of the mission."""
        return self._nodes[name].uri

    def service_uri(self, name: str) -> str:
        """Return the external URI of the services of a node of the mission."""
        return self._nodes[name].service_uri

    def is_own(self, uri: str) -> bool:
        """Return True if an external URI belongs to a node of the mission."""
        return any(each.uri.rstrip("/") == uri.rstrip("/") for each in self._nodes.values())

    def outer(self, value: Any) -> Any:
        """Return a value with the external URIs of the mission's nodes."""
        if isinstance(value, str):
            return self._outer.get(value, value)
        if isinstance(value, (list, tuple)):
            return type(value)(self.outer(each) for each in value)
        return value

    def outer_answer(self, answer: Answer) -> Answer:
        """Return an answer with the external URIs of the mission's nodes."""
        code, text, value = answer
        return code, self.outer(text), self.outer(value)

    def name_at(self, uri: str) -> str:
        """Return the name of the outside node at a URI; "" if it is unknown."""
        return self.world.name_at(uri)

    # -- new and lost nodes --------------------------------------------------------------------------------------------

    def _look(self, now_s: float) -> None:
        self.bounds.places.look(now_s)
        seen = self.see()
        self.world.look(seen, now_s)
        changed, self._params[:] = list(dict.fromkeys(self._params)), []
        if changed:
            self.world.params_changed(changed)
        wanted = {(topic, uri) for topic in seen.subscribed for uri in self.world.publishers_of(topic)}
        for key in [each for each in self._publishers if each not in wanted]:
            self._publishers.pop(key).close()
        for topic, uri in sorted(wanted):
            if (topic, uri) in self._publishers or len(self._publishers) < ROS_PUBLISHERS:
                self._publishers.setdefault((topic, uri), OutsidePublisher(self, topic, uri)).look(now_s)
        self._look_at_services(seen)

    def _look_at_services(self, seen: OwnGraph) -> None:
        """Ask new external services for their type; let calls of lost services fail."""
        offered = self.world.services()
        for service in [each for each, where in self._offered.items() if offered.get(each) != where]:
            del self._offered[service]
            self.act("serve no more", service)
        for service, (name, uri) in offered.items():
            if service not in self._offered:
                self._offered[service] = (name, uri)
                self._probe(service, name, uri)
        here = {service for service, _ in seen.services}
        for number, (service, _) in list(self._calls.items()):
            if service not in here:
                self._answered(number, False, f"service [{service}] has ended".encode())

    def _probe(self, service: str, name: str, uri: str) -> None:
        def over(header: dict[str, str], good: bool, body: bytes) -> None:
            if self._offered.get(service) != (name, uri):
                return
            if good and header.get("md5sum"):
                kind = header.get("type", ANY)
                self.act("serve", service, name, self.world.uri_of(name), uri, kind, header["md5sum"])
            else:
                count = self.counts.of(service, name, OUT_OF)
                count.refused += 1
                count.why = body.decode(errors="replace")

        fields = {"probe": "1", "md5sum": ANY, "callerid": self.world.caller, "service": service}
        OutsideCall(self, service, uri, fields, b"", over)

    # -- the mission's nodes, as others see them -----------------------------------------------------------------------

    def publication(self, topic: str, name: str) -> dict[str, str] | None:
        """Return the connection header of a publisher of the mission, or None if there is none."""
        assert self.ros is not None
        graph = self.ros.graph
        if name == APPLICATIONS:
            return self.shown.header(topic)
        node, compiled = graph.nodes.get(name), graph.compiled.get(name)
        link = self.ros.outside.links.get((topic, name)) if node is None else node.links.get(topic)
        if link is not None and link.topic is not None:
            return dict(link.header)
        if compiled is not None and topic in compiled.published:
            entry = graph.topic(topic)
            fields = {"callerid": name, "latching": "0", "md5sum": entry.md5sum or ANY, "topic": topic}
            return {**fields, "type": entry.type or ANY, "message_definition": entry.definition}
        return None

    def subscription(self, topic: str) -> dict[str, str] | None:
        """Return the connection header of the mission's subscribers of a topic, or None if there are none."""
        name = self.seen.subscribed.get(topic)
        if name is None or self.ros is None:
            return None
        entry = self.ros.graph.topic(topic)
        return {
            "callerid": name,
            "md5sum": entry.md5sum or ANY,
            "message_definition": entry.definition,
            "topic": topic,
            "type": entry.type or ANY,
        }

    def offer(self, service: str, name: str) -> dict[str, str] | None:
        """Return the connection header of a service of the mission, or None if the node does not offer it."""
        assert self.ros is not None
        entry = self.ros.graph.services.get(service)
        if entry is None or entry.service.__node__.names.name != name:
            return None
        kind = entry.service.service_class
        return {"callerid": name, "md5sum": kind._md5sum, "service": service, "type": kind._type}

    def has_room(self, topic: str, publisher: str, payload: bytes) -> bool:
        """Return True if the mission can take a message of an outside publisher now."""
        link = None if self._outside is None else self._outside.links.get((topic, publisher))
        return link is None or link.has_room(payload)

    # -- subscribers outside -----------------------------------------------------------------------------------------

    def add_client(self, topic: str, publisher: str, subscriber: str, client: OutsideClient) -> None:
        """Add a subscriber that has connected."""
        self._clients.setdefault((topic, subscriber), {}).setdefault(publisher, []).append(client)
        if publisher == APPLICATIONS:
            self._ears.setdefault(topic, []).append(client)

    def remove_client(self, topic: str, publisher: str, subscriber: str, client: OutsideClient) -> None:
        """Remove a subscriber whose connection has ended."""
        by_publisher = self._clients.get((topic, subscriber), {})
        clients = by_publisher.get(publisher, [])
        if client in clients:
            clients.remove(client)
        if client in self._ears.get(topic, ()):
            self._ears[topic].remove(client)
        if not clients:
            by_publisher.pop(publisher, None)
        if not by_publisher:
            self._clients.pop((topic, subscriber), None)

    def subscribe(self, topic: str, name: str, kind: str, md5sum: str, publisher: str) -> str:
        """Add an outside subscriber to the graph. Returns the error, or ""."""
        if publisher == APPLICATIONS:
            if topic in self.shown.packets:
                self.act("show", topic, self.shown.packets[topic].msg_id)
            return ""
        wrong: str = self.act("subscribe", topic, name, self.world.uri_of(name), kind, md5sum, publisher)
        return wrong

    def unsubscribe(self, topic: str, name: str, publisher: str) -> None:
        """Remove one of the connections of an outside subscriber."""
        if publisher == APPLICATIONS:
            if topic in self.shown.packets and not self._ears.get(topic):
                self.act("show no more", topic)
            return
        self.act("subscribe no more", topic, name, publisher)

    def message(self, topic: str, publisher: str, subscriber: str, payload: bytes) -> None:
        by_publisher = self._clients.get((topic, subscriber))
        if not by_publisher:
            return
        clients = by_publisher.get(publisher)
        if clients is None:
            if publisher in self.seen.nodes:
                return  # not connected to that publisher yet
            clients = next(iter(by_publisher.values()))
        data = frame(payload)
        for client in clients:
            client.send(data)
        count = self.counts.of(topic, subscriber, OUT_OF)
        count.messages += 1
        count.size += len(payload)

    def packet(self, topic: str, packet: bytes) -> None:
        payload = self.shown.packets[topic].serialize(packet)
        for client in self._ears.get(topic, ()):
            count = self.counts.of(topic, client.caller, OUT_OF)
            if payload is None:
                count.dropped += 1
                count.why = TOO_SHORT
                continue
            client.send(frame(payload))
            count.messages += 1
            count.size += len(payload)

    def _tell_time(self) -> None:
        """Publish the time on /clock. It is not part of the run: the mission's nodes have their time without it."""
        ears, every_ns, now_ns = self._ears.get(CLOCK), self.shown.clock_ns, self._mission.kernel.now
        if not ears or now_ns < self._tell_at_ns:
            return
        self._tell_at_ns = now_ns // every_ns * every_ns + every_ns
        payload = _time(*divmod(self._mission.processor.machine.epoch_ns + now_ns, NS_PER_S))
        for client in ears:
            count = self.counts.of(CLOCK, client.caller, OUT_OF)
            client.send(frame(payload))
            count.messages += 1
            count.size += len(payload)

    # -- calls -------------------------------------------------------------------------------------------------------

    def begin_call(self, service: str, caller: str, request: bytes, client: OutsideClient) -> int:
        """Call a service of the mission for an outside node. Returns the number of the call."""
        self._last_call = number = self._last_call + 1
        self._calls[number] = (service, client)
        try:
            self.act("call", service, number, caller, request)
        except (KeyError, CfeError, UsageError) as error:
            why = f"service [{service}] cannot be called: {error}".encode()
            self._todo.append(lambda: self._answered(number, False, why))
        return number

    def end_call(self, service: str, number: int, caller: str) -> None:
        """Drop a call whose caller is gone."""
        if self._calls.pop(number, None) is not None:
            self.act("forget call", service, number, caller)

    def answer(self, number: int, good: bool, body: bytes) -> None:
        self._todo.append(lambda: self._answered(number, good, body))

    def _answered(self, number: int, good: bool, body: bytes) -> None:
        found = self._calls.pop(number, None)
        if found is None:
            return
        client = found[1]
        try:
            client.answer(good, body)
        except Exception as error:  # its next request is handled here; an error ends only this connection
            client.fail(f"{error}")

    def request(self, service: str, number: int, header: dict[str, str], body: bytes) -> None:
        self._todo.append(lambda: self._call_outside(service, number, header, body))

    def _call_outside(self, service: str, number: int, header: dict[str, str], body: bytes) -> None:
        where = self._offered.get(service)
        if where is None:
            self.act("answer", service, number, False, b"the service has ended")
            return
        name, uri = where
        count = self.counts.of(service, name, OUT_OF)
        count.messages += 1
        count.size += len(body)

        def over(theirs: dict[str, str], good: bool, answer: bytes) -> None:
            if not theirs:
                count.refused += 1
                count.why = answer.decode(errors="replace")
            self.act("answer", service, number, good, answer)

        fields = {each: value for each, value in header.items() if each != "persistent"}
        OutsideCall(self, service, uri, fields, body, over)


def _own(entries: Mapping[str, Mapping[str, str]], nodes: Mapping[str, str]) -> list[tuple[str, str]]:
    """Return those entries of the registry that belong to nodes of the mission."""
    return [(name, who) for name, held in entries.items() for who, uri in held.items() if nodes.get(who) == uri]
