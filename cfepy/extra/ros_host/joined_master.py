"""A running roscore that the mission joins: its nodes register there, and it learns of the others.

Both sides are compared once a second. Missing nodes of the mission are registered with the master, also after it was
killed and started again. Nodes that the master knows are entered into the mission's graph. Notifications of the master
(publisherUpdate, paramUpdate) take effect at once.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any, NamedTuple
from xmlrpc.client import dumps

from cfepy.extra.ros_host.errands import RosError, ask
from cfepy.extra.ros_host.mission_node import MissionNode
from cfepy.extra.ros_host.world import CALLER
from cfepy.status import UsageError
from rospy_shim.parameters.tree import ParameterTree

if TYPE_CHECKING:
    from cfepy.extra.ros_host.host import RosHost
    from cfepy.extra.ros_host.world import OwnGraph

LOOK_S = 1.0  # wall time between two queries of the master
PUBLISHER, SUBSCRIBER, SERVICE = "Publisher", "Subscriber", "Service"
ROOT = "/"


class RosEntry(NamedTuple):
    """A registration: its kind, the topic or service, and the node."""

    kind: str
    name: str
    node: str


class MasterState(NamedTuple):
    """The state of the master: its process, all registrations, types of topics, URIs of nodes and services."""

    pid: int
    entries: list[RosEntry]
    types: dict[str, str]
    nodes: dict[str, str]
    services: dict[str, str]


class JoinedMaster:
    """Joins a master.

    Args:
        host: knows the mission.
        uri: URI of the master.
    """

    def __init__(self, host: RosHost, uri: str) -> None:
        self._host = host
        self.uri = uri
        self.caller = f"{CALLER}_{host.pid}"
        self._own = MissionNode(host, self.caller, "")
        self._registered: dict[RosEntry, str] = {}  # registrations sent to the master, with the node's URI
        self._others: dict[RosEntry, str] = {}  # registrations entered into the mission's graph, with the node's URI
        self._nodes: dict[str, str] = {}
        self._services: dict[str, tuple[str, str]] = {}
        self._publishers: dict[str, list[str]] = {}
        self._told: dict[str, list[str]] = {}  # publishers that the master has announced since the last query
        self._look_at_s = 0.0
        self._params_there: dict[str, Any] = {}
        self._asks = self._is_lost = False
        self._pid = 0
        self._from_there: dict[str, Any] = {}  # parameters as last received from the master

    def begin(self) -> None:
        """Connect to the master; the mission's own parameters are set there, as roslaunch does it."""
        try:
            self._pid = ask(self.uri, "getPid", self.caller)
            self._params_there = self._subscribe_params()
        except (OSError, RosError, ValueError) as error:
            remedy = "start one with roscore, or serve one: --ros-master serve"
            text = f"no ROS master answers at {self.uri}: {error}; {remedy}"
            raise UsageError(text, field="--ros-master") from None
        self._host.tell(f"joined the ROS master at {self.uri}")

    def enter(self) -> None:
        self._others.clear()
        self._exchange_params(self._params_there)
        self._look_at_s = 0.0

    def close(self) -> None:
        """Unregister the mission's nodes from the master, unless it is gone."""
        try:
            for entry, uri in self._registered.items():
                ask(self.uri, f"unregister{entry.kind}", entry.node, entry.name, uri)
            if not self._is_lost:
                ask(self.uri, "unsubscribeParam", self.caller, self._own.uri, ROOT)
        except (OSError, RosError, ValueError):
            pass  # the master is gone, and its registrations with it
        self._own.close()

    # -- registrations -----------------------------------------------------------------------------------------------

    def look(self, seen: OwnGraph, now_s: float) -> None:
        if not self._is_lost:
            self._register(seen)
        if now_s >= self._look_at_s and not self._asks:
            self._asks = True
            self._told.clear()
            self._look_at_s = now_s + LOOK_S
            known = dict(self._nodes)
            own = {*seen.nodes}
            self._host.errands.run(self.uri, lambda: _look_at(self.uri, self.caller, own, known), self._found)

    def _wanted(self, seen: OwnGraph) -> dict[RosEntry, str]:
        host = self._host
        wanted = {RosEntry(PUBLISHER, topic, node): host.node_uri(node) for topic, node in seen.publishers}
        wanted |= {RosEntry(SUBSCRIBER, topic, node): host.node_uri(node) for topic, node in seen.subscribers}
        return wanted | {RosEntry(SERVICE, service, node): host.service_uri(node) for service, node in seen.services}

    def _register(self, seen: OwnGraph) -> None:
        wanted, registered = self._wanted(seen), self._registered
        for entry in [each for each, uri in registered.items() if wanted.get(each) != uri]:
            uri = registered.pop(entry)
            self._ask(f"unregister{entry.kind}", (entry.node, entry.name, uri))
        for entry, uri in wanted.items():
            if entry not in registered:
                registered[entry] = uri
                self._announce(entry, uri, seen)

    def _announce(self, entry: RosEntry, uri: str, seen: OwnGraph) -> None:
        if entry.kind == SERVICE:
            self._ask("registerService", (entry.node, entry.name, uri, self._host.node_uri(entry.node)))
            return

        def done(uris: Any, error: Exception | None) -> None:
            if entry.kind == SUBSCRIBER and error is None:
                self._publishers[entry.name] = list(map(str, uris))
                self._host.soon()

        kind = seen.types.get(entry.name, "*")
        self._ask(f"register{entry.kind}", (entry.node, entry.name, kind, uri), done)

    def _ask(self, method: str, arguments: tuple[Any, ...], done: Callable[..., object] | None = None) -> None:
        self._host.errands.ask(self.uri, method, arguments, done or (lambda result, error: None))

    # -- the state of the master ---------------------------------------------------------------------------------------

    def _found(self, found: MasterState | None, error: Exception | None) -> None:
        self._asks = False
        if found is None:
            if not self._is_lost:
                self._host.tell(f"the ROS master at {self.uri} does not answer: {error}; the mission continues")
            self._is_lost = True
            self._registered.clear()
            return
        if self._is_lost or found.pid != self._pid:
            self._host.tell(f"the ROS master at {self.uri} is back: the mission's nodes register again")
            self._is_lost = False
            self._registered.clear()
            self._pid = found.pid
            self._host.errands.run(self.uri, self._subscribe_params, self._params_again)
        known = {*found.entries}
        for entry in [each for each in self._registered if each not in known]:
            del self._registered[entry]
        self._nodes = found.nodes
        self._enter(found)
        self._host.soon()

    def _enter(self, found: MasterState) -> None:
        """Enter the external registrations of the master into the mission's graph."""
        host = self._host
        seen = host.see()  # a node that has started meanwhile must not give way to remains of a former one
        others = {each: found.nodes[each.node] for each in found.entries if each.node in found.nodes}
        for entry in [each for each, uri in self._others.items() if others.get(each) != uri]:
            uri = self._others.pop(entry)
            host.ask_inside("", _request(f"unregister{entry.kind}", entry.node, entry.name, uri))
        for entry, uri in others.items():
            if entry in self._others or entry.node in seen.nodes:
                continue
            self._others[entry] = uri
            if entry.kind == SERVICE:
                arguments = (entry.node, entry.name, found.services.get(entry.name, ""), uri)
            else:
                arguments = (entry.node, entry.name, found.types.get(entry.name, "*"), uri)
            host.ask_inside("", _request(f"register{entry.kind}", *arguments))
        self._services = {
            each.name: (each.node, found.services[each.name])
            for each in self._others
            if each.kind == SERVICE and found.services.get(each.name)
        }
        self._publishers = {}
        for each, uri in self._others.items():
            if each.kind == PUBLISHER:
                self._publishers.setdefault(each.name, []).append(uri)
        self._publishers |= self._told  # which may be newer than the answer

    def heard(self, node: str, method: str, key: Any, value: Any) -> None:
        if method == "publisherUpdate":
            self._publishers[str(key)] = self._told[str(key)] = [str(each) for each in value]
            self._host.soon()
        else:
            self._take_param(str(key), value)

    def publishers_of(self, topic: str) -> list[str]:
        return [uri for uri in self._publishers.get(topic, ()) if not self._host.is_own(uri)]

    def services(self) -> dict[str, tuple[str, str]]:
        return self._services

    def uri_of(self, name: str) -> str:
        return self._nodes.get(name, "")

    def name_at(self, uri: str) -> str:
        return next((name for name, at in self._nodes.items() if at == uri), "")

    # -- parameters --------------------------------------------------------------------------------------------------

    def _subscribe_params(self) -> dict[str, Any]:
        """Return all parameters that are set there; the master announces changes from now on."""
        found = ask(self.uri, "subscribeParam", self.caller, self._own.uri, ROOT)
        return found if isinstance(found, dict) else {}

    def _params_again(self, there: dict[str, Any] | None, error: Exception | None) -> None:
        if there is not None:
            self._params_there = there
            self._exchange_params(there)

    def _exchange_params(self, there: dict[str, Any]) -> None:
        host = self._host
        assert host.ros is not None
        tree = host.ros.graph.params
        ours = {name: tree.find(name) for name in tree.names()}
        for name, value in _leaves("", there):
            self._from_there[name] = value
            if name not in ours:
                host.ask_inside("", _request("setParam", self.caller, name, value))
        self.params_changed([name for name, value in ours.items() if self._from_there.get(name) != value])

    def params_changed(self, keys: list[str]) -> None:
        """Set the changed parameters at the master, too."""
        host = self._host
        assert host.ros is not None
        if self._is_lost:
            return  # all are set when the master is back
        for key in keys:
            value = host.ros.graph.params.find(key)
            if key in self._from_there and self._from_there.pop(key) == value:
                continue
            if value is ParameterTree.MISSING:
                self._ask("deleteParam", (self.caller, key))
            elif key != ROOT:
                self._ask("setParam", (self.caller, key, value))

    def _take_param(self, key: str, value: Any) -> None:
        host = self._host
        assert host.ros is not None
        key = key.rstrip("/") or ROOT
        here = host.ros.graph.params.find(key)
        if here == value or (here is ParameterTree.MISSING and value == {}):
            return
        self._from_there[key] = ParameterTree.MISSING if value == {} else value
        if value == {}:
            host.ask_inside("", _request("deleteParam", self.caller, key))
        else:
            host.ask_inside("", _request("setParam", self.caller, key, value))


def _look_at(uri: str, caller: str, own: set[str], known: dict[str, str]) -> MasterState:
    """Query the state of the master; known nodes are not looked up again as long as they are registered.

    Raises:
        RosError, OSError: it does not answer, or not as a master does.
        TypeError, ValueError: the same.
    """
    pid = int(ask(uri, "getPid", caller))
    state = ask(uri, "getSystemState", caller)
    types = {str(name): str(kind) for name, kind in ask(uri, "getTopicTypes", caller)}
    kinds = (PUBLISHER, SUBSCRIBER, SERVICE)
    entries = [
        RosEntry(kind, str(name), str(node))
        for kind, part in zip(kinds, state, strict=True)
        for name, who in part
        for node in who
    ]
    nodes: dict[str, str] = {}
    for node in dict.fromkeys(each.node for each in entries if each.node not in own):
        try:
            nodes[node] = str(ask(uri, "lookupNode", caller, node))
        except RosError:
            pass  # it has left meanwhile
    services = {}
    for entry in entries:
        if entry.kind == SERVICE and entry.node in nodes:
            try:
                services[entry.name] = str(ask(uri, "lookupService", caller, entry.name))
            except RosError:
                pass
    return MasterState(pid, entries, types, nodes, services)


def _request(method: str, *arguments: Any) -> bytes:
    return dumps(arguments, method).encode()


def _leaves(above: str, tree: dict[str, Any]) -> list[tuple[str, Any]]:
    found = []
    for name, value in tree.items():
        key = f"{above}/{name}"
        found += _leaves(key, value) if isinstance(value, dict) else [(key, value)]
    return found
