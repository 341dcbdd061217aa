"""`BridgeNode`: the joint node of all clients in the mission's graph, under one name, as in rosbridge_websocket.

A topic that several clients publish or subscribe to has one publisher or subscriber. All input enters through
`cfepy.mission.outside` as host actions. So a journal records it, and a replay needs no client. Output for clients is
kept while the mission's tasks run, and passed on between two steps of the run.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any, Protocol
from xmlrpc.client import dumps

from cfepy.extra.viewers.rosbridge.json_values import Reading, WrongMessage, json_values
from cfepy.extra.viewers.rosbridge.known_types import ANY, KnownTypes, NotPossible
from cfepy.extra.viewers.rosbridge.outgoing import Outgoing
from cfepy.ground import APPLICATIONS, TOO_SHORT, ShownPacket
from cfepy.mission import Mission
from cfepy.msg import get_msg_id
from cfepy.reading.input_limits import ROS_NAME
from cfepy.status import CfeError, UsageError
from cfepy.units import NS_PER_S
from rospy_shim.master.xmlrpc_calls import Answer, resolve
from rospy_shim.types.msgs import MessageClass, ServiceClass
from rospy_shim.types.names import is_legal_name

if TYPE_CHECKING:
    from rospy_shim.graph.outside import OutsideGraph
    from rospy_shim.runtime import RosRuntime

NODE = "/rosbridge_websocket"
ACT = "ros"
UNREGISTER_S = 10.0  # wall time for which a publisher outlives its last client, as rosbridge's `unregister_timeout`
MOST_WAITING = 1 << 27  # bytes of messages that are kept in a step of the run


class Hearer(Protocol):
    """The interface of a client for the node."""

    def heard(self, topic: str, message: Outgoing) -> None:
        """Take a message of a topic that it has subscribed to."""

    def requested(self, service: str, number: str, values: dict[str, Any]) -> None:
        """Take a call of a service that it offers."""


class _Published:
    """A topic that clients publish."""

    def __init__(self, kind: MessageClass, latching: bool) -> None:
        self.kind = kind
        self.latching = latching
        self.clients: set[Hearer] = set()
        self.seq = 0
        self.leaves_at_s = float("inf")


class _Heard:
    """A topic that clients subscribe to."""

    def __init__(self, kind: MessageClass | None) -> None:
        self.kind = kind  # None as long as only raw messages are wanted
        self.clients: dict[Hearer, None] = {}
        self.publishers: set[str] = set()  # to which the node is connected
        self.latched: dict[str, Outgoing] = {}  # by publisher


class _Offered:
    """A service that a client offers."""

    def __init__(self, client: Hearer, kind: ServiceClass) -> None:
        self.client = client
        self.kind = kind
        self.calls: dict[str, int] = {}  # numbers of calls by the ids that the client knows


class BridgeNode:
    """The node.

    Args:
        mission: the mission.
        uri: URI of the node, for the master.
        lost: called for each dropped message: its topic, and the reason.
        packets: shown packets of applications, by topic.

    Attributes:
        types: the known types.
        reading: makes messages from the clients' values.
        packets: as given.
    """

    def __init__(
        self,
        mission: Mission,
        uri: str,
        lost: Callable[[str, str], object],
        packets: Mapping[str, ShownPacket],
    ) -> None:
        self.types = KnownTypes(mission, packets)
        self.packets = packets
        self.reading = Reading(self.types.message_class, self.ros_time)
        self._lost = lost
        self._mission = mission
        self._uri = uri
        self._ros: RosRuntime | None = None
        self._published: dict[str, _Published] = {}
        self._heard: dict[str, _Heard] = {}
        self._offered: dict[str, _Offered] = {}
        self._calls: dict[int, tuple[str, ServiceClass, Callable[[bool, Any], object]]] = {}
        self._last_call = self._last_request = 0
        self._aside: deque[Callable[[], object]] = deque()
        self._messages: deque[tuple[str, str, bytes]] = deque()
        self._waiting = 0
        self._is_over = False

    # -- the mission ---------------------------------------------------------------------------------------------------

    @property
    def ros(self) -> RosRuntime | None:
        """The ROS side of the mission; None before its first node, or before a client needs it."""
        return self._mission.ros

    def ros_time(self) -> tuple[int, int]:
        """Return the mission's ROS time in s and ns."""
        return divmod(self._mission.processor.machine.epoch_ns + self._mission.kernel.now, NS_PER_S)

    def exchange(self, now_s: float) -> None:
        """Pass on the mission's output to clients, and look for new and lost publishers and services.

        Args:
            now_s: wall time in s since an arbitrary instant.
        """
        if self._ros is not None and self._mission.ros is not self._ros:
            self._again()
        aside, self._aside = self._aside, deque()
        for each in aside:
            each()
        messages, self._messages, self._waiting = self._messages, deque(), 0
        for topic, publisher, payload in messages:
            self._deliver(topic, publisher, payload)
        for topic in [name for name, each in self._published.items() if now_s >= each.leaves_at_s]:
            self._stop_publishing(topic)
        self._look()

    def close(self) -> None:
        """Stop all input at the end of the run."""
        self._is_over = True
        if self._ros is not None:
            self._ros.outside.ways_out.pop(NODE, None)

    def _act(self, name: str, *values: Any) -> Any:
        """Perform a host action on the mission's graph (`OutsideGraph.do`); a journal records it."""
        if self._is_over:
            return ""
        try:
            return self._mission.outside.act(ACT, name, *values)
        except CfeError as error:
            raise NotPossible(str(error)) from None

    def ask(self, method: str, *arguments: Any) -> Answer:
        """Send the mission's master a request that changes it.

        Raises:
            NotPossible: it is refused, or XML-RPC cannot carry an argument.
        """
        try:
            body = dumps((NODE, *arguments), method).encode()
        except (TypeError, ValueError, OverflowError, RecursionError) as error:
            raise NotPossible(str(error)) from None
        if self._is_over:
            return 0, "the run is over", 0
        self._begin()
        answer: Answer = self._act("ask", "", body)
        return answer

    def _begin(self) -> OutsideGraph:
        """Return the ROS side; make it if there was no node yet."""
        if self._ros is None or self._mission.ros is not self._ros:
            self._mission.outside.act(ACT)
            ros = self._ros = self._mission.ros
            assert ros is not None
            ros.outside.ways_out[NODE] = self
            return ros.outside
        return self._ros.outside

    def _again(self) -> None:
        """Restore the clients' entries in the graph after a processor reset."""
        self._ros = None
        for number in list(self._calls):
            self._answered(number, False, b"the processor was reset")
        for topic, published in list(self._published.items()):
            try:
                self._register_publisher(topic, published)
            except UsageError:
                del self._published[topic]
        for topic, heard in self._heard_in_graph():
            heard.publishers.clear()
            heard.latched.clear()
            try:
                self._register_subscriber(topic, heard)
            except UsageError:
                pass  # its MsgId belongs to another topic now; the subscription stays without messages
        for service, offered in self._offered.items():
            offered.calls.clear()
            self._register_service(service, offered)

    def resolved(self, name: str) -> str:
        """Return the full name for a name.

        Raises:
            NotPossible: it is not a legal ROS name (wiki.ros.org/Names).
        """
        if not name or len(name) > ROS_NAME or not is_legal_name(name) or name.strip("/~") == "":
            raise NotPossible(f"{name[:200]!r} is not a legal name")
        return resolve(name, NODE)

    # -- topics --------------------------------------------------------------------------------------------------------

    def _fitting(self, topic: str, kind: str | None) -> MessageClass:
        """Return the class of a topic's messages.

        Args:
            topic: its full name.
            kind: the type that a client gives; None takes it from the graph.

        Raises:
            NotPossible: the type is unknown, or differs from the one in the graph.
        """
        established = self.types.topic_type(topic)
        if kind is None and not established:
            raise NotPossible(f"Cannot infer topic type for topic {topic} as it is not yet advertised")
        found = self.types.message_class(kind or established)
        if established and established != found._type:
            text = f"Tried to register topic {topic} with type {found._type} but it is already established with type"
            raise NotPossible(f"{text} {established}")
        return found

    # -- publishers ----------------------------------------------------------------------------------------------------

    def advertise(self, client: Hearer, topic: str, kind: str | None, latching: bool) -> None:
        """Let a client publish a topic.

        Raises:
            NotPossible: it cannot.
        """
        published = self._published.get(topic)
        if published is None:
            published = _Published(self._fitting(topic, kind), latching)
            self._register_publisher(topic, published)
            self._published[topic] = published
        elif kind is not None and self.types.message_class(kind)._type != published.kind._type:
            self._fitting(topic, kind)
        published.clients.add(client)
        published.leaves_at_s = float("inf")

    def _register_publisher(self, topic: str, published: _Published) -> None:
        kind = published.kind
        self.ask("registerPublisher", topic, kind._type, self._uri)
        try:
            texts = (kind._type, kind._md5sum, kind._full_text)
            wrong = self._act("publish", topic, NODE, self._uri, *texts, published.latching)
        except UsageError as error:
            wrong = str(error)
        if wrong:
            self.ask("unregisterPublisher", topic, self._uri)
            raise NotPossible(f"topic {topic}: {wrong}")

    def unadvertise(self, client: Hearer, topic: str, now_s: float) -> None:
        """End a client's publication of a topic. After the last client, the publisher stays for a while."""
        published = self._published.get(topic)
        if published is not None and client in published.clients:
            published.clients.remove(client)
            if not published.clients:
                published.leaves_at_s = now_s + UNREGISTER_S

    def _stop_publishing(self, topic: str) -> None:
        del self._published[topic]
        self._act("publish no more", topic, NODE)
        self.ask("unregisterPublisher", topic, self._uri)

    def packed(self, topic: str, values: Any) -> bytes:
        """Serialize a message for a published topic, as ROS does.

        Raises:
            UsageError: the values are not such a message.
        """
        published = self._published[topic]
        payload = self.reading.serialized(values, published.kind, published.seq + 1)
        published.seq += 1
        return payload

    def has_room(self, topic: str, payload: bytes) -> bool:
        """Return True if the mission can take a message now."""
        link = None if self._ros is None else self._ros.outside.links.get((topic, NODE))
        return link is None or link.has_room(payload)

    def publish(self, topic: str, payload: bytes) -> bool:
        """Enter a message of a client, and pass it to subscribed clients. Returns True if the bus took it."""
        took: bool = self._act("message", topic, NODE, payload)
        if topic in self._heard:
            self._put(topic, NODE, payload)
        return took

    # -- subscribers ---------------------------------------------------------------------------------------------------

    def subscribe(self, client: Hearer, topic: str, kind: str | None, raw: bool) -> None:
        """Subscribe a client to a topic; it gets the latched messages.

        Args:
            client: the client.
            topic: full name.
            kind: the type that it wants; None takes it from the graph.
            raw: it wants serialised messages, regardless of their type.

        Raises:
            NotPossible: it cannot.
        """
        heard = self._heard.get(topic)
        found = None if raw else self._fitting(topic, kind)
        if heard is None:
            heard = _Heard(found)
            if topic in self.packets:
                self._heard[topic] = heard
            else:
                self._register_subscriber(topic, heard)
                self._heard[topic] = heard
                self._connect(topic, heard, self._publishers_of(topic))
        if heard.kind is None and found is not None:
            heard.kind = found
            for message in heard.latched.values():
                message.kind = found
        heard.clients[client] = None
        for message in heard.latched.values():  # also for a client that subscribes again
            client.heard(topic, message)

    def _register_subscriber(self, topic: str, heard: _Heard) -> None:
        kind = heard.kind
        name, md5sum = (ANY, ANY) if kind is None else (kind._type, kind._md5sum)
        self.ask("registerSubscriber", topic, name, self._uri)
        try:
            wrong = self._act("subscribe", topic, NODE, self._uri, name, md5sum, "")
        except UsageError as error:
            wrong = str(error)
        if wrong:
            self.ask("unregisterSubscriber", topic, self._uri)
            raise NotPossible(f"topic {topic}: {wrong}")

    def _publishers_of(self, topic: str) -> set[str]:
        """Return the nodes that publish a topic, except this one."""
        assert self._ros is not None
        return {*self._ros.switchboard.master.registry.publishers().get(topic, {})} - {NODE}

    def _connect(self, topic: str, heard: _Heard, publishers: set[str]) -> None:
        """Connect to new publishers of a topic, and disconnect from lost ones."""
        kind = heard.kind
        name, md5sum = (ANY, ANY) if kind is None else (kind._type, kind._md5sum)
        for publisher in sorted(heard.publishers - publishers):
            heard.publishers.discard(publisher)
            heard.latched.pop(publisher, None)
            self._act("subscribe no more", topic, NODE, publisher)
        for publisher in sorted(publishers - heard.publishers):
            heard.publishers.add(publisher)
            self._act("subscribe", topic, NODE, self._uri, name, md5sum, publisher)

    def _look(self) -> None:
        """Look for new and lost publishers of subscribed topics, and for lost services."""
        if self._ros is None or not (self._heard or self._calls):
            return
        publishers = self._ros.switchboard.master.registry.publishers()
        for topic, heard in self._heard_in_graph():
            others = {*publishers.get(topic, {})} - {NODE}
            if others != heard.publishers:
                self._connect(topic, heard, others)
        for number, (service, _, _) in list(self._calls.items()):
            if service not in self._ros.graph.services:
                self._answered(number, False, f"service [{service}] has ended".encode())

    def unsubscribe(self, client: Hearer, topic: str) -> None:
        """End a client's subscription of a topic."""
        heard = self._heard.get(topic)
        if heard is None or client not in heard.clients:
            return
        del heard.clients[client]
        if not heard.clients:
            del self._heard[topic]
            if topic in self.packets:
                return
            for publisher in ("", *sorted(heard.publishers)):
                self._act("subscribe no more", topic, NODE, publisher)
            self.ask("unregisterSubscriber", topic, self._uri)

    def _heard_in_graph(self) -> list[tuple[str, _Heard]]:
        """Return subscriptions of topics of nodes. Those of shown packets are left out, because the mission does not
        see them.
        """
        return [(topic, heard) for topic, heard in self._heard.items() if topic not in self.packets]

    def show(self, packet: bytes) -> None:
        """Show a packet that an application has sent; called inside the simulation."""
        msg_id = get_msg_id(packet)
        for topic, shown in self.packets.items():
            if shown.msg_id != msg_id or topic not in self._heard:
                continue
            payload = shown.serialize(packet)
            if payload is None:
                self._lost(topic, TOO_SHORT)
            else:
                self._put(topic, APPLICATIONS, payload)

    def _put(self, topic: str, publisher: str, payload: bytes) -> None:
        """Keep a message for the clients."""
        if self._waiting + len(payload) > MOST_WAITING:
            self._lost(topic, "too much between two pieces of the run")
        else:
            self._waiting += len(payload)
            self._messages.append((topic, publisher, payload))

    def _deliver(self, topic: str, publisher: str, payload: bytes) -> None:
        heard = self._heard.get(topic)
        if heard is None:
            return
        message = Outgoing(payload, heard.kind, self.ros_time())
        if self._latches(topic, publisher):
            heard.latched[publisher] = message
        for client in list(heard.clients):
            client.heard(topic, message)

    def _latches(self, topic: str, publisher: str) -> bool:
        if publisher == NODE:
            return topic in self._published and self._published[topic].latching
        if topic in self.packets:
            return False
        assert self._ros is not None
        node = self._ros.graph.nodes.get(publisher)
        link = self._ros.outside.links.get((topic, publisher)) if node is None else node.links.get(topic)
        return link is not None and link.is_latch

    # -- calls of services ---------------------------------------------------------------------------------------------

    def call(self, service: str, arguments: Any, over: Callable[[bool, Any], object]) -> int:
        """Call a service.

        Args:
            service: full name.
            arguments: a dict of fields, or a list of their values in order; any other value means no arguments.
            over: receives True and the values of the response, or False and the error.

        Returns:
            The number of the call.

        Raises:
            UsageError: it cannot be called with these arguments.
        """
        kind = self.types.class_of_service(service)
        if kind is None:
            raise NotPossible(f"Service {service} does not exist")
        body = self.reading.serialized(fields_of(arguments, kind._request_class), kind._request_class)
        self._begin()
        self._last_call = number = self._last_call + 1
        self._calls[number] = (service, kind, over)
        try:
            self._act("call", service, number, NODE, body)
        except NotPossible:
            del self._calls[number]
            raise
        return number

    def forget_call(self, number: int) -> None:
        """Drop a call whose client no longer waits for the answer."""
        found = self._calls.pop(number, None)
        if found is not None:
            self._act("forget call", found[0], number, NODE)

    def _answered(self, number: int, good: bool, body: bytes) -> None:
        found = self._calls.pop(number, None)
        if found is None:
            return
        service, kind, over = found
        if not good:
            over(False, f"service [{service}] responded with an error: {body!r}")
            return
        try:
            values = _values_of(body, kind._response_class)
        except WrongMessage as error:
            over(False, f"service [{service}] has sent a response that cannot be read: {error}")
        else:
            over(True, values)

    # -- services of clients -------------------------------------------------------------------------------------------

    def offer(self, client: Hearer, service: str, kind: str) -> bool:
        """Offer a service of a client. Returns True if it replaces the service of another client.

        Raises:
            NotPossible: it cannot.
        """
        offered = _Offered(client, self.types.service_class(kind))
        is_again = service in self._offered
        if is_again:
            self.withdraw(service)
        self._register_service(service, offered)
        self._offered[service] = offered
        return is_again

    def _register_service(self, service: str, offered: _Offered) -> None:
        address = f"rosrpc://{self._uri.partition('://')[2].rstrip('/')}"
        self._begin()
        kind = offered.kind
        if not self._act("serve", service, NODE, self._uri, address, kind._type, kind._md5sum):
            raise NotPossible(f"service {service} is already offered by the mission")
        self.ask("registerService", service, address, self._uri)

    def offers(self, service: str) -> Hearer | None:
        """Return the client that offers a service, or None."""
        offered = self._offered.get(service)
        return None if offered is None else offered.client

    def offered_by(self, client: Hearer) -> int:
        """Return the number of services that a client offers."""
        return sum(each.client is client for each in self._offered.values())

    def withdraw(self, service: str) -> None:
        """Withdraw a service. Pending calls get an error as their answer."""
        offered = self._offered.pop(service)
        for number in offered.calls.values():
            self._act("answer", service, number, False, b"the service has ended")
        self._act("serve no more", service)
        address = f"rosrpc://{self._uri.partition('://')[2].rstrip('/')}"
        self.ask("unregisterService", service, address)

    def withdraw_all(self, client: Hearer) -> None:
        """Withdraw all services of a client that is gone."""
        for service in [name for name, each in self._offered.items() if each.client is client]:
            self.withdraw(service)

    def _request(self, service: str, number: int, body: bytes) -> None:
        offered = self._offered.get(service)
        if offered is None:
            return  # the caller got an error when the service was withdrawn
        try:
            values = _values_of(body, offered.kind._request_class)
        except WrongMessage as error:
            self._act("answer", service, number, False, f"service cannot process request: {error}".encode())
            return
        self._last_request += 1
        name = f"service_request:{service}:{self._last_request}"
        offered.calls[name] = number
        offered.client.requested(service, name, values)

    def respond(self, service: str, name: str, values: Any) -> None:
        """Send a client's answer to a call.

        Raises:
            UsageError: no call waits for it, or it is not a response of the service. In the latter case the call fails.
        """
        offered = self._offered[service]
        number = offered.calls.pop(name, None)
        if number is None:
            raise NotPossible(f"unexpected answer {name} of service {service}; no client is waiting for it")
        try:
            body = self.reading.serialized(values, offered.kind._response_class)
        except UsageError as error:
            self._act("answer", service, number, False, str(error).encode())
            raise
        self._act("answer", service, number, True, body)

    # -- output, called in the mission's tasks (`WayOut`) --------------------------------------------------------------

    def message(self, topic: str, publisher: str, subscriber: str, payload: bytes) -> None:
        self._put(topic, publisher, payload)

    def packet(self, topic: str, packet: bytes) -> None:
        """Do nothing: packets of applications are watched (`show`)."""

    def request(self, service: str, number: int, header: dict[str, str], body: bytes) -> None:
        self._aside.append(lambda: self._request(service, number, body))

    def answer(self, number: int, good: bool, body: bytes) -> None:
        self._aside.append(lambda: self._answered(number, good, body))


def _values_of(body: bytes, kind: MessageClass) -> dict[str, Any]:
    """Return the values of a serialised message, which may come from an external program.

    Raises:
        WrongMessage: the bytes are not a message of the type.
    """
    try:
        return json_values(kind().deserialize(body))
    except Exception as error:  # the generated code may raise any error for bytes of another type
        raise WrongMessage(f"{kind._type}: {error}") from None


def fields_of(arguments: Any, kind: MessageClass) -> dict[str, Any]:
    """Return the fields of a request, from a dict of them or a list of their values in order."""
    if isinstance(arguments, list):
        return dict(zip(kind.__slots__, arguments, strict=False))
    return arguments if isinstance(arguments, dict) else {}
