"""ROS nodes outside of the mission, as its graph sees them: with publishers, subscribers and services like all others.

`OutsideGraph` performs the actions of programs on this computer on the graph. Their arguments are plain values, so that
a journal records them and a replay repeats them (`cfepy.mission.host_actions`). The mission's output for these programs
goes to `OutsideGraph.way_out`, which is None in a replay. Nothing here waits for them: a message for an outside
subscriber is passed on at once.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol
from xmlrpc.client import loads

from cfepy.reading.input_limits import ROS_CALLS, ROS_NAMES
from cfepy.sb import Outlet
from cfepy.status import CFE_ES_NO_RESOURCE_IDS_AVAILABLE, CfeError, UsageError
from rospy_shim.client.service import (
    ANSWER_LEAD,
    REQUEST_LEAD,
    Pieces,
    answer_packets,
    call_of_answer,
    call_of_request,
    request_packets,
)
from rospy_shim.client.subscription import NO_PIPE
from rospy_shim.graph.compiled import DeclaredType
from rospy_shim.graph.graph import MOST_NAMES, ServiceCall
from rospy_shim.graph.outside_nodes import OutsideLink, OutsideNode, OutsideService, OutsideSubscription
from rospy_shim.master.xmlrpc_calls import call
from rospy_shim.types.exceptions import ServiceException

if TYPE_CHECKING:
    from cfepy.app import Cfe
    from cfepy.rtos import Kernel
    from rospy_shim.graph.graph import Graph, Header, ServiceEntry, TopicEntry
    from rospy_shim.master import Switchboard
    from rospy_shim.master.xmlrpc_calls import Answer

PACE_NS = 100_000  # period of looking for room for the next packet of a request
PRIORITY = 100  # of a task that calls a compiled node's service, as a node's


class WayOut(Protocol):
    """Receives the mission's output. It is called in the mission's tasks, and must not wait."""

    def message(self, topic: str, publisher: str, subscriber: str, payload: bytes) -> None:
        """Take a message for an outside subscriber. `publisher` is "" if the sender is not a ROS node."""

    def packet(self, topic: str, packet: bytes) -> None:
        """Take a packet of cFE applications that is shown as a topic."""

    def request(self, service: str, number: int, header: Header, body: bytes) -> None:
        """Take a request for an outside service; `number` is the number of the call."""

    def answer(self, number: int, good: bool, body: bytes) -> None:
        """Take the answer to a call from outside: the serialised response, or an error's text."""


class OutsideGraph:
    """The actions of outside nodes on the graph of a mission.

    Args:
        graph: the graph.
        switchboard: finds the master and the nodes of the mission.
        cfe: the services.
        kernel: the kernel of the simulated computer.

    Attributes:
        nodes: the outside nodes in the graph.
        links: their publishers.
        subscriptions: their subscribers.
        services: their services.
        way_out: receives the output; None drops it.
        ways_out: receives the output for nodes with their own way out, by their names. Nodes with the same way out
            reach each other without the mission.
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
        self._entering = ""  # the outside node whose message comes in
        self._pieces: dict[str, Pieces] = {}  # of long requests, by service
        # By service and its number: the caller's number, and the caller; None if it does not wait any more.
        self._calls: dict[str, dict[int, tuple[int, str] | None]] = {}
        self._outlets: dict[str, Outlet] = {}  # by service
        self._shown: dict[str, Outlet] = {}  # by topic
        self._names: set[str] = set()  # of topics and services that came from outside
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
        """Perform one action; names and values are those of the methods below.

        Raises:
            KeyError: there is no such action, topic, node or service.
            UsageError: a topic's MsgId belongs to another topic.
            CfeError: the bus is full.
        """
        return self._acts[name](*values)

    # -- the master --------------------------------------------------------------------------------------------------

    def _ask(self, node: str, body: bytes) -> Answer:
        """Perform a changing request in the form of XML-RPC. Returns the answer.

        Args:
            node: the node of the mission that gets the request; "" for the master.
            body: method and arguments.
        """
        try:
            arguments, method = loads(body, use_builtin_types=True)
        except Exception as error:  # the parser raises a dozen kinds of errors for an invalid request
            return -1, f"this is not a request: {error}", 0
        api = self._switchboard.api_of(node) if node else self._switchboard.master
        if api is None:
            return 0, f"[{node}] is not a node of the mission", 0
        return call(api, str(method), arguments)

    # -- topics ------------------------------------------------------------------------------------------------------

    def _node(self, name: str, uri: str) -> OutsideNode:
        node = self.nodes.get(name)
        if node is None:
            node = self.nodes[name] = OutsideNode(name, uri, self._graph, self._cfe, self._kernel)
        node.uri = uri or node.uri
        return node

    def _topic(self, name: str) -> TopicEntry:
        """Return the topic of a name, which nodes of the mission may not have.

        Raises:
            UsageError: its MsgId belongs to another topic, or too many names come from outside. Each takes a MsgId for
                the rest of the run, and the mission needs some for itself.
        """
        if name not in self._graph.topics:
            self._count_name(name)
        return self._graph.topic(name)

    def _count_name(self, name: str) -> None:
        if len(self._names) >= ROS_NAMES and name not in self._names:
            raise UsageError(f"{name[:200]}: the limit of {ROS_NAMES} names of external programs is reached")
        self._names.add(name)

    def _publish(self, topic: str, name: str, uri: str, kind: str, md5sum: str, definition: str, latching: bool) -> str:
        """Connect the mission with an outside publisher. Returns the error, or ""."""
        entry, declared = self._topic(topic), DeclaredType(kind, md5sum, definition)
        self._publish_no_more(topic, name)
        if not entry.join(declared):
            return f"it is {kind} [{md5sum}] there and {entry.type} [{entry.md5sum}] here"
        self.links[topic, name] = OutsideLink(self._node(name, uri), entry, declared, latching)
        return ""

    def _publish_no_more(self, topic: str, name: str) -> None:
        link = self.links.pop((topic, name), None)
        if link is not None:
            link.close()
            self._forget_node(name)

    def _forget_node(self, name: str) -> None:
        """Forget an outside node that has nothing in the graph any more, if there are many.

        Tools use a new name at each start.
        """
        if len(self.nodes) <= MOST_NAMES:
            return
        sides = (*self.links, *self.subscriptions)
        offers = any(each.__node__.names.name == name for each in self.services.values())
        if not offers and not any(node == name for _, node in sides):
            self.nodes.pop(name, None)

    def _message(self, topic: str, name: str, payload: bytes) -> bool:
        """Enter a message from an outside publisher. Returns True if the bus took it."""
        self._entering = name
        try:
            return self.links[topic, name].enter(payload)
        finally:
            self._entering = ""

    def _subscribe(self, topic: str, name: str, uri: str, kind: str, md5sum: str, publisher: str) -> str:
        """Connect an outside subscriber with a node of the mission, "" for its cFE applications. Returns the error,
        or "".
        """
        entry = self._topic(topic)
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
                if not each.is_outside:  # its messages come at once
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
        """Send the latched message of an outside publisher to a subscriber with another way out."""
        link = self.links.get((topic, publisher))
        if link is None or self._way_to(publisher) is self._way_to(subscription.node.names.name):
            return
        if link.is_latch and link.latch is not None and not link.raw:
            subscription.deliver(link.latch, link.header)

    def _way_to(self, name: str) -> WayOut | None:
        """Return the way out to an outside node."""
        return self.ways_out.get(name, self.way_out)

    def _reaches(self, name: str) -> bool:
        """Return True if the publisher of the entering message reaches an outside node without the mission."""
        return self._entering != "" and self._way_to(self._entering) is self._way_to(name)

    def _out_to(self, topic: str, subscriber: str) -> Callable[[str, bytes], None]:
        def out(publisher: str, payload: bytes) -> None:
            way = self._way_to(subscriber)
            if way is not None:
                way.message(topic, publisher, subscriber, payload)

        return out

    def _subscribe_no_more(self, topic: str, name: str, publisher: str) -> None:
        """Remove one of a subscriber's connections; with the last one the subscriber is removed."""
        subscription = self.subscriptions.get((topic, name))
        if subscription is None:
            return
        if publisher in subscription.publishers:
            subscription.publishers.remove(publisher)
        if not subscription.publishers:
            del self.subscriptions[topic, name]
            subscription.close()
            self._forget_node(name)

    def _show(self, topic: str, msg_id: int) -> None:
        """Show packets of cFE applications to the outside."""
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
        """Call a service of the mission for an outside node.

        Raises:
            KeyError: there is no such service.
            CfeError: too many calls of it wait, each of which may take a task.
        """
        entry = self._graph.services[service]
        if len(entry.calls) >= ROS_CALLS:
            raise CfeError(
                CFE_ES_NO_RESOURCE_IDS_AVAILABLE, f"the limit of {ROS_CALLS} pending calls of {service} is reached"
            )
        header = {"callerid": caller, "md5sum": entry.service.service_class._md5sum, "service": service}
        self._listen(service, entry)
        inner = entry.begin(ServiceCall(NO_PIPE, header))
        self._calls[service][inner] = (number, caller)
        packets = list(request_packets(entry.request_id, inner, body, self._cfe.sb.config.sb_max_msg_size))

        def send() -> None:
            for packet in packets:
                while not entry.service.__has_room__(packet):
                    if self._graph.services.get(service) is not entry:
                        return
                    entry.service.__attend__()
                    self._kernel.delay(PACE_NS)
                self._cfe.sb.transmit_msg(packet)
                entry.service.__attend__()

        if all(entry.service.__has_room__(packet) for packet in packets):
            send()
            return
        node = self._graph.nodes.get(entry.service.__node__.names.name)
        if node is not None:
            node.start_task("host", send)
        else:
            self._kernel.spawn(f"call of {service}", send, PRIORITY)

    def _listen(self, service: str, entry: ServiceEntry) -> None:
        """Receive the answers of a service of the mission."""
        outlet = self._outlets.get(service)
        if outlet is None:
            self._calls[service] = {}
            pieces = Pieces(ANSWER_LEAD)

            def take(packet: bytes) -> None:
                inner, good = call_of_answer(packet)
                body = pieces.add(inner, packet) if inner in self._calls[service] else None
                if body is None:
                    return
                outer = self._calls[service].pop(inner)
                current = self._graph.services.get(service)
                if current is not None:
                    current.calls.pop(inner, None)
                    current.half_answered.discard(inner)
                if outer is not None:
                    number, caller = outer
                    way = self._way_to(caller)
                    if way is not None:
                        way.answer(number, good, body)

            self._outlets[service] = Outlet(self._cfe.sb, entry.answer_id, f"answers of {service}", take)

    def _forget_call(self, service: str, number: int, caller: str) -> None:
        """Drop a call whose caller does not wait for the answer any more."""
        calls = self._calls.get(service, {})
        for inner in [each for each, outer in calls.items() if outer == (number, caller)]:
            calls[inner] = None  # the service still works on it

    # -- services of outside nodes -----------------------------------------------------------------------------------

    def _serve(self, service: str, name: str, uri: str, address: str, kind: str, md5sum: str) -> bool:
        """Offer a service of an outside node. Returns False if the mission has one of that name."""
        former = self._graph.services.get(service)
        if former is not None and not isinstance(former.service, OutsideService):
            return False
        self._serve_no_more(service)
        self._count_name(service)
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
            way, call = self._way_to(entry.service.__node__.names.name), entry.calls.get(number)
            if body is not None and way is not None and call is not None:
                way.request(service, number, call.header, body)

        return Outlet(self._cfe.sb, entry.request_id, f"requests to {service}", take)

    def _serve_no_more(self, service: str) -> None:
        made = self.services.pop(service, None)
        if made is not None:
            made.close()
            entry = self._graph.services.get(service)
            if entry is not None and entry.service is made:
                del self._graph.services[service]
            self._forget_node(made.__node__.names.name)

    def _answer(self, service: str, number: int, good: bool, body: bytes) -> bool:
        """Send the answer of an outside service. Returns False if no call waits for it."""
        entry = self._graph.services.get(service)
        if entry is None or number not in entry.calls:
            return False
        try:
            for packet in answer_packets(entry.answer_id, number, good, body, self._cfe.sb.config.sb_max_msg_size):
                self._cfe.sb.transmit_msg(packet)
        except CfeError:
            return False
        return True
