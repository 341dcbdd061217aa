"""The mission's graph for viewers: its parameters, its services, its publishers and subscribers."""

from __future__ import annotations

import time
from typing import TYPE_CHECKING, Any, NamedTuple
from xmlrpc.client import dumps

from cfepy.extra.viewers.foxglove.protocol import ROS1, Called, Graph, ParametersSet, service_failure, service_response
from cfepy.extra.viewers.foxglove.viewer import Viewer
from cfepy.extra.viewers.foxglove.viewer_server import NOTHING, ViewerServer
from cfepy.mission import ROS, Mission
from cfepy.status import CfeError, UsageError
from rospy_shim.parameters.tree import ParameterTree

if TYPE_CHECKING:
    from rospy_shim.graph.graph import Graph as RosGraph

CALLER = "/foxglove"
HIGHEST, LOWEST = 2**63 - 1, -(2**63)
CALL_S = 60.0  # wall time for which a viewer waits for an answer
MOST_CALLS = 32  # pending calls of one viewer; as in foxglove-sdk


class ParameterMirror:
    """The mission's parameters, as viewers know them.

    Args:
        server: sends changes to viewers.
    """

    def __init__(self, server: ViewerServer) -> None:
        self._server = server
        self._tree: ParameterTree | None = None
        self._is_stale = False

    def watch(self, tree: ParameterTree) -> None:
        """Watch the parameters of a new graph."""
        self._tree = tree
        self._is_stale = True
        tree.on_change(self._changed)

    def _changed(self, key: str) -> None:
        self._is_stale = True

    def look(self) -> None:
        """Send changes to the viewers."""
        tree = self._tree
        if not self._is_stale or tree is None:
            return
        self._is_stale = False
        before, now = self._server.values, {name: _plain(tree.find(name)) for name in tree.names()}
        self._server.values = now
        changed = [name for name, value in now.items() if name not in before or before[name] != value]
        gone = [name for name in before if name not in now]
        if changed or gone:
            self._server.tell_parameters([*changed, *gone])

    def set(self, mission: Mission, wanted: ParametersSet) -> None:
        """Set parameters for a viewer, and send it the resulting values at once."""
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
        self._server.tell_parameters(wanted.values)


def _plain(value: Any) -> Any:
    """Convert a value to the types that viewers accept."""
    if isinstance(value, dict):
        return {str(name): _plain(each) for name, each in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(each) for each in value]
    if isinstance(value, int) and not LOWEST <= value <= HIGHEST:
        return str(value)
    return value if isinstance(value, str | int | float | bool | bytes) else str(value)


class _Call(NamedTuple):
    """A call that waits for its answer."""

    viewer: Viewer
    wanted: Called
    since_s: float


class ServiceMirror:
    """The mission's services, for viewers to call.

    Args:
        server: offers them.
    """

    def __init__(self, server: ViewerServer) -> None:
        self._server = server
        self._offered: dict[str, tuple[int | None, str]] = {}
        """The viewers' number of a service and its md5sum; the number is None if the service is not offered to them."""
        self._calls: dict[int, _Call] = {}
        self._last = 0

    def look(self, graph: RosGraph) -> None:
        """Offer new services, withdraw lost ones, and end calls that have waited for too long."""
        here = {name: entry.service.service_class for name, entry in list(graph.services.items())}
        known = {name: kind._md5sum for name, kind in here.items() if kind._md5sum not in ("", "*")}
        gone = [name for name, (_, md5sum) in self._offered.items() if known.get(name) != md5sum]
        numbers = [self._offered.pop(name)[0] for name in gone]
        self._server.withdraw([number for number in numbers if number is not None])
        for name, md5sum in known.items():
            if name not in self._offered:
                self._offer(graph, name, md5sum)
        now_s = time.monotonic()
        for number in [number for number, call in self._calls.items() if now_s - call.since_s > CALL_S]:
            self._fail(self._calls.pop(number), "the service has not answered")

    def _offer(self, graph: RosGraph, name: str, md5sum: str) -> None:
        try:
            _, kind = graph.caller(name)
            request, response = kind._request_class._full_text, kind._response_class._full_text
        except Exception:  # a compiled node's service, with a type that no Python node knows: it cannot be described
            self._offered[name] = (None, md5sum)
        else:
            self._offered[name] = (self._server.offer(name, kind._type, request, response), md5sum)

    def begin(self, mission: Mission, viewer: Viewer, wanted: Called, way_out: Any) -> None:
        """Call a service of the mission for a viewer."""
        call = _Call(viewer, wanted, time.monotonic())
        service = next((name for name, (number, _) in self._offered.items() if number == wanted.service), None)
        if service is None:
            self._fail(call, "unknown service")
        elif wanted.encoding != ROS1:
            self._fail(call, f"the encoding of a request must be {ROS1}, not {wanted.encoding[:40]}")
        elif sum(each.viewer is viewer for each in self._calls.values()) >= MOST_CALLS:
            self._fail(call, f"the limit of {MOST_CALLS} pending calls is reached")
        else:
            self._enter(mission, service, call, way_out)

    def _enter(self, mission: Mission, service: str, call: _Call, way_out: Any) -> None:
        self._last = number = self._last + 1
        self._calls[number] = call
        try:
            mission.outside.act(ROS)
            assert mission.ros is not None
            mission.ros.outside.ways_out[CALLER] = way_out
            mission.outside.act(ROS, "call", service, number, CALLER, call.wanted.request)
        except (KeyError, CfeError, UsageError) as error:
            self.answer(number, False, f"service {service} cannot be called: {error}".encode())

    def answer(self, number: int, good: bool, body: bytes) -> None:
        """Send the answer of the mission."""
        call = self._calls.pop(number, None)
        if call is None:
            return
        if good:
            call.viewer.tell(service_response(call.wanted.service, call.wanted.call, body))
        else:
            self._fail(call, body.decode(errors="replace") or "the service has failed")

    def _fail(self, call: _Call, why: str) -> None:
        call.viewer.tell(service_failure(call.wanted.service, call.wanted.call, why))

    def gone(self, viewer: Viewer) -> None:
        """Drop the calls of a viewer that has left."""
        self._calls = {number: call for number, call in self._calls.items() if call.viewer is not viewer}

    def forget(self, why: str) -> None:
        """Let all pending calls fail."""
        calls, self._calls = self._calls, {}
        for call in calls.values():
            self._fail(call, why)


class GraphMirror:
    """Publishers, subscribers and services for viewers.

    Args:
        server: sends the graph to viewers.
    """

    def __init__(self, server: ViewerServer) -> None:
        self._server = server
        self._told = NOTHING

    def look(self, graph: RosGraph) -> None:
        """Send the graph if it has changed."""
        published, subscribed = {}, {}
        for name, entry in list(graph.topics.items()):
            published[name] = [link.node.names.name for link in entry.links]
            published[name] += [node.names.name for node in entry.compiled_publishers]
            subscribed[name] = [each.node.names.name for each in entry.subscriptions]
            subscribed[name] += [node.names.name for node in entry.compiled_subscribers]
        services = {name: [entry.service.__node__.names.name] for name, entry in list(graph.services.items())}
        found: Graph = (published, subscribed, services)
        if found != self._told:
            self._told = found
            self._server.tell_graph(found)
