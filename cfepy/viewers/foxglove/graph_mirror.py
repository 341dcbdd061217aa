"""What viewers are told of the mission's graph: its parameters, its services, who publishes and hears what."""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Mapping
from typing import TYPE_CHECKING, Any
from xmlrpc.client import dumps

from cfepy.mission import ROS, Mission
from cfepy.status import CfeError, UsageError
from cfepy.viewers.foxglove.inbox import Called, ParametersSet
from cfepy.viewers.foxglove.sdk_server import SdkServer
from rospy_shim.parameters.tree import ParameterTree

if TYPE_CHECKING:
    from rospy_shim.graph.graph import Graph

CALLER = "/foxglove"
HIGHEST, LOWEST = 2**63 - 1, -(2**63)
CALL_S = 60.0  # wall time for which a viewer waits for an answer

Graphs = tuple[dict[str, tuple[list[str], list[str]]], dict[str, list[str]]]


class ParameterMirror:
    """The mission's parameters, as the server's threads may read them.

    Args:
        server: tells viewers of changes.

    Attributes:
        values: all of them by name; replaced, never changed.
    """

    def __init__(self, server: SdkServer) -> None:
        self.values: Mapping[str, Any] = {}
        self._server = server
        self._tree: ParameterTree | None = None
        self._is_stale = False

    def watch(self, tree: ParameterTree) -> None:
        """The graph is new, or the first one."""
        self._tree = tree
        self._is_stale = True
        tree.on_change(self._changed)

    def _changed(self, key: str) -> None:
        self._is_stale = True

    def look(self) -> None:
        """Tell of what has changed."""
        tree = self._tree
        if not self._is_stale or tree is None:
            return
        self._is_stale = False
        before, now = self.values, {name: _plain(tree.find(name)) for name in tree.names()}
        self.values = now
        changed = [name for name, value in now.items() if name not in before or before[name] != value]
        gone = [name for name in before if name not in now]
        if changed or gone:
            self.tell([*changed, *gone])

    def tell(self, names: list[str]) -> None:
        """Tell what parameters are now."""
        values = self.values
        self._server.tell_parameters(self._server.parameter(name, values.get(name)) for name in names)

    def set(self, mission: Mission, wanted: ParametersSet) -> None:
        """A viewer sets parameters; what was not possible it sees at once."""
        for name, value in wanted.values.items():
            arguments = (CALLER, name) if value is None else (CALLER, name, value)
            try:
                body = dumps(arguments, "deleteParam" if value is None else "setParam").encode()
                code, text, _ = mission.outside.act(ROS, "ask", "", body)
                why = "" if code == 1 else str(text)
            except (CfeError, UsageError, TypeError, OverflowError, ValueError) as error:
                why = str(error)
            if why:
                self._server.tell_problem(f"parameter {name} cannot be set: {why}", f"parameter {name}")
        self._is_stale = True
        self.look()
        self.tell(list(wanted.values))


def _plain(value: Any) -> Any:
    """A value as the library takes it."""
    if isinstance(value, dict):
        return {str(name): _plain(each) for name, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    if isinstance(value, int) and not LOWEST <= value <= HIGHEST:
        return str(value)
    return value if isinstance(value, str | int | float | bool | bytes) else str(value)


class ServiceMirror:
    """The mission's services, for viewers to call.

    Args:
        server: offers them.
        put: leaves a call in the inbox; False when it found no room.
    """

    def __init__(self, server: SdkServer, put: Callable[[Called], bool]) -> None:
        self._server = server
        self._put = put
        self._offered: dict[str, str] = {}  # with the md5sum
        self._calls: dict[int, Called] = {}
        self._last = 0
        self._is_over = False

    def look(self, graph: Graph) -> None:
        """Offer what is new, and what is gone no more."""
        here = {name: entry.service.service_class for name, entry in list(graph.services.items())}
        known = {name: kind for name, kind in here.items() if kind._md5sum not in ("", "*")}
        gone = [name for name, md5sum in self._offered.items() if name not in known or known[name]._md5sum != md5sum]
        if gone:
            self._server.withdraw(gone)
        for name in gone:
            del self._offered[name]
        for name, kind in known.items():
            if name not in self._offered:
                self._offered[name] = kind._md5sum
                self._offer(graph, name)

    def _offer(self, graph: Graph, name: str) -> None:
        try:
            _, kind = graph.caller(name)
            request, response = kind._request_class._full_text, kind._response_class._full_text
        except Exception:  # a compiled node's, of a type that no node in Python knows: it cannot be described
            return
        self._server.offer(name, kind._type, request, response, self._handle)

    def _handle(self, request: Any) -> bytes:
        """In a thread of the server, which waits: the run goes on meanwhile, and answers."""
        call = Called(request.client_id, request.service_name, bytes(request.payload))
        if self._is_over or not self._put(call) or not call.over.wait(CALL_S):
            raise RuntimeError(f"service {call.service} has not answered")
        if call.error:
            raise RuntimeError(call.error)
        return call.answer

    def begin(self, mission: Mission, call: Called, way_out: Any) -> None:
        """A viewer calls a service of the mission."""
        self._last = number = self._last + 1
        self._calls[number] = call
        try:
            mission.outside.act(ROS)
            assert mission.ros is not None
            mission.ros.outside.ways_out[CALLER] = way_out
            mission.outside.act(ROS, "call", call.service, number, CALLER, call.request)
        except (KeyError, CfeError, UsageError) as error:
            self.answer(number, False, f"service {call.service} cannot be called: {error}".encode())

    def answer(self, number: int, good: bool, body: bytes) -> None:
        """The mission has answered."""
        call = self._calls.pop(number, None)
        if call is not None:
            call.end(body, "" if good else body.decode(errors="replace") or "the service has failed")

    def forget(self) -> None:
        """The graph that was asked is gone."""
        for call in self._calls.values():
            call.end(b"", f"service {call.service} has ended")
        self._calls.clear()

    def close(self) -> None:
        """The run is over."""
        self._is_over = True
        self.forget()


class GraphMirror:
    """Who publishes and hears what.

    Args:
        server: tells it.
    """

    def __init__(self, server: SdkServer) -> None:
        self._server = server
        self._told: Graphs = ({}, {})

    def look(self, graph: Graph) -> None:
        """Tell it, if it is another than before."""
        topics = {}
        for name, entry in list(graph.topics.items()):
            publishers = [link.node.names.name for link in entry.links]
            publishers += [node.names.name for node in entry.compiled_publishers]
            hearers = [each.node.names.name for each in entry.subscriptions]
            hearers += [node.names.name for node in entry.compiled_subscribers]
            topics[name] = (publishers, hearers)
        services = {name: [entry.service.node.names.name] for name, entry in list(graph.services.items())}
        found = (topics, services)
        if found != self._told:
            self._told = found
            with contextlib.suppress(RuntimeError):  # the server is closing
                self._server.tell_graph(topics, services)
