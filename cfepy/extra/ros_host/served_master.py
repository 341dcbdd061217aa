"""A ROS master that the mission serves: external programs register with it, and it tells them about its nodes.

It gives the answers of the mission's own master (`rospy_shim.master`), with addresses that can be reached from outside.
A request that changes a registration or a parameter is a host action on the mission.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from cfepy.extra.ros_host.world import CALLER
from cfepy.extra.ros_host.xmlrpc_server import XmlRpcServer
from cfepy.reading.input_limits import ROS_NAME, ROS_REGISTRATIONS
from cfepy.status import UsageError
from rospy_shim.master.xmlrpc_calls import call, resolve
from rospy_shim.parameters.tree import ParameterTree

if TYPE_CHECKING:
    from cfepy.extra.ros_host.host import RosHost
    from cfepy.extra.ros_host.world import OwnGraph
    from rospy_shim.master.registrations import Registrations

MASTER_PORT = 11311
MASTER = "/master"
REGISTER, UNREGISTER = "register", "unregister"
PARAMS = frozenset({"setParam", "deleteParam"})
SUBSCRIPTIONS = frozenset({"subscribeParam", "unsubscribeParam"})


class ServedMaster:
    """Serves the master.

    Args:
        host: knows the mission.
        port: 0 takes any free one.

    Raises:
        UsageError: the port is taken.
    """

    caller = CALLER

    def __init__(self, host: RosHost, port: int = MASTER_PORT) -> None:
        self._host = host
        try:
            self._server = XmlRpcServer(host.selector, host.address.interface, self._answer, host.bounds, port)
        except OSError as error:
            remedy = "another master may run there; serve:PORT takes another port"
            text = f"port {port} cannot be opened: {error.strerror}; {remedy}"
            raise UsageError(text, field="--ros-master") from None
        self.uri = f"http://{host.address.host}:{self._server.port}/"
        self._told: dict[str, list[str]] = {}  # publishers of topics, as outside subscribers know them
        self._entered: dict[tuple[str, ...], bytes] = {}  # current registrations, to repeat after a reset

    def begin(self) -> None:
        self._host.tell(f"ROS master at {self.uri}: export ROS_MASTER_URI={self.uri}")

    def enter(self) -> None:
        """Repeat the registrations of outside nodes."""
        for body in self._entered.values():
            self._host.ask_inside("", body)

    def close(self) -> None:
        self._server.close()

    @property
    def _registry(self) -> Registrations:
        assert self._host.ros is not None
        return self._host.ros.switchboard.master.registry

    # -- requests ----------------------------------------------------------------------------------------------------

    def _answer(self, method: str, arguments: Sequence[Any], body: bytes) -> Any:
        host = self._host
        host.see()
        if method == "getUri":
            return 1, "", self.uri
        if method == "getPid":
            return 1, "", host.pid
        if method.startswith((REGISTER, UNREGISTER)) or method in PARAMS | SUBSCRIPTIONS:
            wrong = self._excess(method, arguments)
            if wrong:
                return -1, f"ERROR: {wrong}", 0
            answer = host.ask_inside("", body)
            if answer[0] == 1:
                self._remember(method, arguments, body)
                host.soon()
            return answer
        assert host.ros is not None
        return host.outer_answer(call(host.ros.switchboard.master, method, arguments))

    def _excess(self, method: str, arguments: Sequence[Any]) -> str:
        """Check the size limits of a changing request. Returns the error, or ""."""
        names = arguments[:2] if method in PARAMS else arguments
        if any(isinstance(each, str) and len(each) > ROS_NAME for each in names):
            return f"a name has more than {ROS_NAME:,} characters"
        if method in PARAMS or method.startswith("un") or len(self._entered) < ROS_REGISTRATIONS:
            return ""
        return f"the limit of {ROS_REGISTRATIONS:,} registrations is reached"

    def _remember(self, method: str, arguments: Sequence[Any], body: bytes) -> None:
        if method in PARAMS:
            return  # critical tables keep them
        caller, *rest = map(str, arguments)
        name = resolve(rest[1] if method in SUBSCRIPTIONS else rest[0], caller)
        if method.startswith(("un",)):
            kind = method.removeprefix("un")
            self._entered.pop((kind[:1].lower() + kind[1:], name, caller), None)
        else:
            self._entered[method, name, caller] = body

    # -- the mission and outside nodes -------------------------------------------------------------------------------

    def look(self, seen: OwnGraph, now_s: float) -> None:
        """Notify outside subscribers of a topic if its publishers have changed."""
        registry = self._registry
        publishers, told = registry.publishers(), {}
        for topic, held in registry.subscribers().items():
            uris = self._host.outer(list(publishers.get(topic, {}).values()))
            outside = [uri for name, uri in held.items() if seen.nodes.get(name) != uri]
            if outside and uris != self._told.get(topic, []):
                for uri in outside:
                    self._tell(uri, "publisherUpdate", topic, uris)
            told[topic] = uris
        self._told = told

    def params_changed(self, keys: list[str]) -> None:
        """Notify the subscribers of the parameters."""
        host = self._host
        assert host.ros is not None
        for subscribed, held in self._registry.param_subscribers.items():
            for key in keys:
                if not (_is_below(key, subscribed) or _is_below(subscribed, key)):
                    continue
                told = key if _is_below(key, subscribed) else subscribed
                value = host.ros.graph.params.find(told)
                for name, uri in held.items():
                    if host.seen.nodes.get(name) != uri:
                        self._tell(uri, "paramUpdate", f"{told}/", {} if value is ParameterTree.MISSING else value)

    def _tell(self, uri: str, method: str, *arguments: Any) -> None:
        self._host.errands.ask(uri, method, (MASTER, *arguments), lambda result, error: None)

    def heard(self, node: str, method: str, key: Any, value: Any) -> None:
        """Do nothing: only this master sends such notifications, and its state is current."""

    def publishers_of(self, topic: str) -> list[str]:
        nodes = self._host.seen.nodes
        return [uri for name, uri in self._registry.publishers().get(topic, {}).items() if nodes.get(name) != uri]

    def services(self) -> dict[str, tuple[str, str]]:
        nodes, registry = self._host.seen.nodes, self._registry
        found = {}
        for service, body in [(key[1], key[2]) for key in self._entered if key[0] == "registerService"]:
            if body not in nodes:
                uri = registry.service_uri_by_hand(service)
                if uri:
                    found[service] = (body, uri)
        return found

    def uri_of(self, name: str) -> str:
        return self._registry.node_uri(name) or ""

    def name_at(self, uri: str) -> str:
        return next(
            (name for held in self._registry.publishers().values() for name, at in held.items() if at == uri), ""
        )


def _is_below(key: str, above: str) -> bool:
    return f"{key}/".startswith(f"{above.rstrip('/')}/")
