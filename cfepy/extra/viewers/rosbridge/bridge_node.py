"""`BridgeNode`: what all clients together have in the mission's graph, under one name, as rosbridge_websocket has it.

A topic that several clients publish or hear has one publisher or subscriber. All that enters goes through
`cfepy.mission.outside` as acts, so a journal has it, and a replay needs no client. What the mission has for clients is
put aside while its tasks run, and handed on between two pieces of the run.
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
MOST_WAITING = 1 << 27  # bytes of messages that are put aside in a piece of the run


class Hearer(Protocol):
    """A client, as the node sees it."""

    def heard(self, topic: str, message: Outgoing) -> None:
        """A message of a topic that it has subscribed to."""

    def requested(self, service: str, number: str, values: dict[str, Any]) -> None:
        """A call of a service that it offers."""


class _Published:
    """A topic that clients publish."""

    def __init__(self, kind: MessageClass, latching: bool) -> None:
        self.kind = kind
        self.latching = latching
        self.clients: set[Hearer] = set()
        self.seq = 0
        self.leaves_at_s = float("inf")


class _Heard:
    """A topic that clients hear."""

    def __init__(self, kind: MessageClass | None) -> None:
        self.kind = kind  # None as long as only raw messages are wanted
        self.clients: dict[Hearer, None] = {}
        self.publishers: set[str] = set()  # with which the node is connected
        self.latched: dict[str, Outgoing] = {}  # by publisher


class _Offered:
    """A service that a client offers."""

    def __init__(self, client: Hearer, kind: ServiceClass) -> None:
        self.client = client
        self.kind = kind
        self.calls: dict[str, int] = {}  # numbers of calls by what the client knows them by


class BridgeNode:
    """The node.

    Args:
        mission: the mission.
        uri: where the node answers, for the master.
        lost: told of each message that was left out: its topic, and why.
        packets: those of applications that are shown, by topic.

    Attributes:
        types: what is known of types.
        reading: makes messages of what clients send.
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
        """The mission's ROS time, s and ns."""
        return divmod(self._mission.processor.machine.epoch_ns + self._mission.kernel.now, NS_PER_S)

    def exchange(self, now_s: float) -> None:
        """Hand on what the mission has for clients, and look who has come and gone.

        Args:
            now_s: wall time since some instant.
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
        """The run is over: nothing enters any more."""
        self._is_over = True
        if self._ros is not None:
            self._ros.outside.ways_out.pop(NODE, None)

    def _act(self, name: str, *values: Any) -> Any:
        """Do something to the mission's graph (`OutsideGraph.do`), through the door that a journal has."""
        if self._is_over:
            return ""
        try:
            return self._mission.outside.act(ACT, name, *values)
        except CfeError as error:
            raise NotPossible(str(error)) from None

    def ask(self, method: str, *arguments: Any) -> Answer:
        """Ask the mission's master for something that changes it.

        Raises:
            NotPossible: it cannot be, or an argument is nothing that XML-RPC carries.
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
        """The ROS side, made if there was no node yet."""
        if self._ros is None or self._mission.ros is not self._ros:
            self._mission.outside.act(ACT)
            ros = self._ros = self._mission.ros
            assert ros is not None
            ros.outside.ways_out[NODE] = self
            return ros.outside
        return self._ros.outside

    def _again(self) -> None:
        """The processor was reset: what clients had in the graph is there again."""
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
                pass  # its MsgId is another topic's now; nobody is heard there
        for service, offered in self._offered.items():
            offered.calls.clear()
            self._register_service(service, offered)

    def resolved(self, name: str) -> str:
        """The full name that a name means.

        Raises:
            NotPossible: it is no name of ROS's (wiki.ros.org/Names).
        """
        if not name or len(name) > ROS_NAME or not is_legal_name(name) or name.strip("/~") == "":
            raise NotPossible(f"{name[:200]!r} is not a legal name")
        return resolve(name, NODE)

    # -- topics --------------------------------------------------------------------------------------------------------

    def _fitting(self, topic: str, kind: str | None) -> MessageClass:
        """The class of a topic's messages.

        Args:
            topic: its full name.
            kind: the type that a client gives; None leaves it to the graph.

        Raises:
            NotPossible: it is unknown, or another one.
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
        """A client publishes a topic.

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
        """A client publishes a topic no longer; the last one leaves it open for a while."""
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
        """A message for a topic that is published, as ROS serialises it.

        Raises:
            UsageError: it is none.
        """
        published = self._published[topic]
        payload = self.reading.serialized(values, published.kind, published.seq + 1)
        published.seq += 1
        return payload

    def has_room(self, topic: str, payload: bytes) -> bool:
        """Whether the mission takes a message now."""
        link = None if self._ros is None else self._ros.outside.links.get((topic, NODE))
        return link is None or link.has_room(payload)

    def publish(self, topic: str, payload: bytes) -> bool:
        """A message of a client enters; whether the bus took it. Clients that hear the topic get it in any case."""
        took: bool = self._act("message", topic, NODE, payload)
        if topic in self._heard:
            self._put(topic, NODE, payload)
        return took

    # -- subscribers ---------------------------------------------------------------------------------------------------

    def subscribe(self, client: Hearer, topic: str, kind: str | None, raw: bool) -> None:
        """A client hears a topic; it gets what is latched there.

        Args:
            client: the client.
            topic: full name.
            kind: type that it wants; None leaves it to the graph.
            raw: it wants the messages as they are, whatever their type.

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
        for message in heard.latched.values():  # also for one that subscribes again
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
        """Nodes that publish a topic, but for this one."""
        assert self._ros is not None
        return {*self._ros.switchboard.master.registry.publishers().get(topic, {})} - {NODE}

    def _connect(self, topic: str, heard: _Heard, publishers: set[str]) -> None:
        """Connect with those publishers of a topic that are new, and leave those that are gone."""
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
        """See who publishes what clients hear, and which services are gone."""
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
        """A client hears a topic no longer."""
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
        """What clients hear of nodes; packets of applications are watched, and the mission does not see it."""
        return [(topic, heard) for topic, heard in self._heard.items() if topic not in self.packets]

    def show(self, packet: bytes) -> None:
        """An application has sent a packet; called inside the simulation."""
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
        """Put a message aside."""
        self._waiting += len(payload)
        if self._waiting > MOST_WAITING:
            self._lost(topic, "too much between two pieces of the run")
        else:
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
            arguments: a dict of fields, or a list of their values in order; anything else is no arguments.
            over: gets whether it went well, and the values of the response or what went wrong.

        Returns:
            The number of the call.

        Raises:
            UsageError: it cannot be called like this.
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
        """Nobody waits for the answer any more."""
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
        """A client offers a service; whether another one did, which does no more.

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
        """The client that offers a service."""
        offered = self._offered.get(service)
        return None if offered is None else offered.client

    def offered_by(self, client: Hearer) -> int:
        """How many services a client offers."""
        return sum(each.client is client for each in self._offered.values())

    def withdraw(self, service: str) -> None:
        """A service is offered no longer; who waits for an answer is told."""
        offered = self._offered.pop(service)
        for number in offered.calls.values():
            self._act("answer", service, number, False, b"the service has ended")
        self._act("serve no more", service)
        address = f"rosrpc://{self._uri.partition('://')[2].rstrip('/')}"
        self.ask("unregisterService", service, address)

    def withdraw_all(self, client: Hearer) -> None:
        """A client is gone."""
        for service in [name for name, each in self._offered.items() if each.client is client]:
            self.withdraw(service)

    def _request(self, service: str, number: int, body: bytes) -> None:
        offered = self._offered.get(service)
        if offered is None:
            return  # who called was told when it was withdrawn
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
        """A client answers a call.

        Raises:
            UsageError: nobody waits for it, or it is no response; the caller is told.
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

    # -- what goes out, in the mission's tasks (`WayOut`) --------------------------------------------------------------

    def message(self, topic: str, publisher: str, subscriber: str, payload: bytes) -> None:
        self._put(topic, publisher, payload)

    def packet(self, topic: str, packet: bytes) -> None:
        """Packets of applications are watched (`show`), and not asked for."""

    def request(self, service: str, number: int, header: dict[str, str], body: bytes) -> None:
        self._aside.append(lambda: self._request(service, number, body))

    def answer(self, number: int, good: bool, body: bytes) -> None:
        self._aside.append(lambda: self._answered(number, good, body))


def _values_of(body: bytes, kind: MessageClass) -> dict[str, Any]:
    """The values of a serialised message, which may come from a program outside.

    Raises:
        WrongMessage: the bytes are not a message of the type.
    """
    try:
        return json_values(kind().deserialize(body))
    except Exception as error:  # whatever the generated code raises for bytes that are no such message
        raise WrongMessage(f"{kind._type}: {error}") from None


def fields_of(arguments: Any, kind: MessageClass) -> dict[str, Any]:
    """The fields of a request, of a dict of them or a list of their values in order."""
    if isinstance(arguments, list):
        return dict(zip(kind.__slots__, arguments, strict=False))
    return arguments if isinstance(arguments, dict) else {}
