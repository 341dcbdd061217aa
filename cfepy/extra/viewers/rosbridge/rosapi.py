"""The introspection services of rosapi: topics, nodes, services, types, parameters (wiki.ros.org/rosapi).

They are answered from the mission's graph, without the mission, so that a query does not affect it. Changes of
parameters do enter it.
"""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any
from urllib.parse import urlsplit

from cfepy.extra.viewers.bounded_json import loads
from cfepy.extra.viewers.rosbridge.bridge_node import NODE, BridgeNode, fields_of
from cfepy.extra.viewers.rosbridge.known_types import ANY, NotPossible
from cfepy.ground import APPLICATIONS
from cfepy.reading.input_limits import ROS_NAME
from cfepy.status import UsageError
from rospy_shim.master.registrations import Entries
from rospy_shim.master.xmlrpc_calls import resolve
from rospy_shim.parameters.tree import ParameterTree
from rospy_shim.types.msgs import MessageClass, shipped
from rospy_shim.types.names import is_legal_name

NAME = "/rosapi"
ACTION_TOPICS = ("cancel", "feedback", "goal", "result", "status")
TIMES = ("time", "duration")
ATOMS = frozenset(
    {
        *("bool", "byte", "char", "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64"),
        *("float32", "float64", "string"),
    }
)
Values = dict[str, Any]
TypeDef = dict[str, Any]
"""A message rosapi/TypeDef."""


class Rosapi:
    """Answers the services.

    Args:
        node: knows the mission.
        uri: URI of the node rosapi.
    """

    def __init__(self, node: BridgeNode, uri: str) -> None:
        self._node = node
        self._host = urlsplit(uri).hostname or ""
        self.services: dict[str, tuple[str, Callable[[Any], Values]]] = {
            f"{NAME}/{name}": (f"rosapi/{kind}", answer)
            for name, (kind, answer) in {
                "topics": ("Topics", self._topics),
                "topics_for_type": ("TopicsForType", self._topics_for_type),
                "topics_and_raw_types": ("TopicsAndRawTypes", self._topics_and_raw_types),
                "services": ("Services", lambda asked: {"services": sorted(self._providers())}),
                "services_for_type": ("ServicesForType", self._services_for_type),
                "nodes": ("Nodes", lambda asked: {"nodes": self._nodes()}),
                "node_details": ("NodeDetails", self._node_details),
                "action_servers": ("GetActionServers", self._action_servers),
                "topic_type": ("TopicType", lambda asked: {"type": self._node.types.topic_type(asked.topic)}),
                "service_type": ("ServiceType", lambda asked: {"type": self._service_type(asked.service)}),
                "publishers": ("Publishers", lambda asked: {"publishers": _who(self._publishers(), asked.topic)}),
                "subscribers": ("Subscribers", lambda asked: {"subscribers": _who(self._subscribers(), asked.topic)}),
                "service_providers": ("ServiceProviders", self._service_providers),
                "service_node": ("ServiceNode", self._service_node),
                "service_host": ("ServiceHost", self._service_host),
                "message_details": ("MessageDetails", self._message_details),
                "service_request_details": ("ServiceRequestDetails", self._request_details),
                "service_response_details": ("ServiceResponseDetails", self._response_details),
                "set_param": ("SetParam", self._set_param),
                "get_param": ("GetParam", self._get_param),
                "has_param": ("HasParam", lambda asked: {"exists": self._find(asked.name) is not _MISSING}),
                "search_param": ("SearchParam", self._search_param),
                "delete_param": ("DeleteParam", self._delete_param),
                "get_param_names": ("GetParamNames", self._param_names),
                "get_time": ("GetTime", self._time),
            }.items()
        }

    def call(self, service: str, arguments: Any) -> Values:
        """Return the values of the answer.

        Args:
            service: one of `services`.
            arguments: as for `BridgeNode.call`.

        Raises:
            UsageError: the request is invalid, or cannot be done.
        """
        kind, answer = self.services[service]
        request = shipped().service_class(kind)._request_class
        asked = self._node.reading.message(fields_of(arguments, request), request)
        try:
            return answer(asked)
        except UsageError as error:
            text = f"error processing request: {error}".encode()
            raise NotPossible(f"service [{service}] responded with an error: {text!r}") from None

    # -- the graph -----------------------------------------------------------------------------------------------------

    def _publishers(self) -> Entries:
        """Return the master's publishers, and the node that stands for applications whose packets are shown."""
        ros = self._node.ros
        found = {} if ros is None else ros.switchboard.master.registry.publishers()
        return found | {topic: {APPLICATIONS: "", **found.get(topic, {})} for topic in self._node.packets}

    def _subscribers(self) -> Entries:
        ros = self._node.ros
        return {} if ros is None else ros.switchboard.master.registry.subscribers()

    def _providers(self) -> Entries:
        """Return services with the nodes that offer them, including rosapi's own."""
        ros = self._node.ros
        found = {} if ros is None else ros.switchboard.master.registry.providers()
        return {**found, **{name: {NAME: ""} for name in self.services}}

    def _nodes(self) -> list[str]:
        entries = (self._publishers(), self._subscribers(), self._providers())
        found = dict.fromkeys(name for each in entries for held in each.values() for name in held)
        return [*dict.fromkeys([*found, NAME, NODE])]

    def _topic_types(self) -> list[tuple[str, str]]:
        """Return topics with a publisher or subscriber, and their types; "" for an unknown type."""
        topics = dict.fromkeys([*self._publishers(), *self._subscribers()])
        return [(topic, self._node.types.topic_type(topic)) for topic in topics]

    def _topics(self, asked: Any) -> Values:
        found = self._topic_types()
        return {"topics": [topic for topic, _ in found], "types": [kind for _, kind in found]}

    def _topics_for_type(self, asked: Any) -> Values:
        ros = self._node.ros
        types = {} if ros is None else ros.switchboard.master.registry.topic_types()
        types = types | {topic: shown.type.name for topic, shown in self._node.packets.items()}
        return {"topics": [topic for topic, kind in types.items() if kind == asked.type]}

    def _topics_and_raw_types(self, asked: Any) -> Values:
        found = self._topics(asked)
        return {**found, "typedefs_full_text": [self._full_text(kind) for kind in found["types"]]}

    def _full_text(self, kind: str) -> str:
        try:
            return self._node.types.message_class(kind)._full_text
        except UsageError:
            return ""

    def _node_details(self, asked: Any) -> Values:
        return {
            "subscribing": _of(self._subscribers(), asked.node),
            "publishing": _of(self._publishers(), asked.node),
            "services": _of(self._providers(), asked.node),
        }

    def _action_servers(self, asked: Any) -> Values:
        topics = {topic for topic, _ in self._topic_types()}
        places = sorted({topic.rpartition("/")[0] for topic in topics} - {""})
        return {
            "action_servers": [place for place in places if all(f"{place}/{each}" in topics for each in ACTION_TOPICS)]
        }

    # -- services ------------------------------------------------------------------------------------------------------

    def _service_type(self, service: str) -> str:
        own = self.services.get(service)
        if own is not None:
            return own[0]
        try:
            kind = self._node.types.class_of_service(service)
        except UsageError:
            return ""
        return "" if kind is None or kind._type == ANY else kind._type

    def _services_for_type(self, asked: Any) -> Values:
        return {"services": [name for name in sorted(self._providers()) if self._service_type(name) == asked.type]}

    def _service_providers(self, asked: Any) -> Values:
        """Return the providers by the type of the service, as rosapi does."""
        providers = self._providers()
        return {
            "providers": [
                node for name in providers if self._service_type(name) == asked.service for node in providers[name]
            ]
        }

    def _service_node(self, asked: Any) -> Values:
        return {"node": next(iter(self._providers().get(asked.service, {})), "")}

    def _service_host(self, asked: Any) -> Values:
        if asked.service in self.services:
            return {"host": self._host}
        ros = self._node.ros
        uri = None if ros is None else ros.switchboard.master.registry.service_uri(asked.service)
        return {"host": urlsplit(uri).hostname or "" if uri else ""}

    # -- types ---------------------------------------------------------------------------------------------------------

    def _message_details(self, asked: Any) -> Values:
        return {"typedefs": typedefs(asked.type, self._node.types.message_class)}

    def _request_details(self, asked: Any) -> Values:
        kind = self._node.types.service_class(asked.type)._request_class
        return {"typedefs": typedefs_of(kind, self._node.types.message_class)}

    def _response_details(self, asked: Any) -> Values:
        kind = self._node.types.service_class(asked.type)._response_class
        return {"typedefs": typedefs_of(kind, self._node.types.message_class)}

    # -- parameters ----------------------------------------------------------------------------------------------------

    @property
    def _params(self) -> ParameterTree | None:
        ros = self._node.ros
        return None if ros is None else ros.graph.params

    def _find(self, name: str) -> Any:
        return _MISSING if self._params is None else self._params.find(_resolved(name))

    def _set_param(self, asked: Any) -> Values:
        try:
            value = loads(asked.value)
        except ValueError:
            text = "Due to the type flexibility of the ROS parameter server, the value argument to set_param must be a"
            raise NotPossible(f"{text} JSON-formatted string.") from None
        self._change("setParam", _resolved(asked.name), value)
        return {}

    def _get_param(self, asked: Any) -> Values:
        value = self._find(asked.name)
        if value is _MISSING:
            try:
                value = loads(asked.default) if asked.default else None
            except ValueError:
                value = asked.default
        return {"value": json.dumps(value, default=str)}

    def _search_param(self, asked: Any) -> Values:
        name = asked.name
        if name.startswith("/"):
            return {"global_name": name if self._find(name) is not _MISSING else ""}
        found = None if self._params is None else self._params.search(NAME, name)
        return {"global_name": found or ""}

    def _delete_param(self, asked: Any) -> Values:
        name = _resolved(asked.name)
        if self._find(name) is not _MISSING:
            self._change("deleteParam", name)
        return {}

    def _change(self, method: str, *arguments: Any) -> None:
        code, text, _ = self._node.ask(method, *arguments)
        if code != 1:
            raise NotPossible(text)

    def _param_names(self, asked: Any) -> Values:
        return {"names": [] if self._params is None else self._params.names()}

    def _time(self, asked: Any) -> Values:
        secs, nsecs = self._node.ros_time()
        return {"time": {"secs": secs, "nsecs": nsecs}}


_MISSING = ParameterTree.MISSING


def _resolved(name: str) -> str:
    if not name or len(name) > ROS_NAME or not is_legal_name(name):
        raise NotPossible(f"{name[:200]!r} is not a legal name of a parameter")
    return resolve(name, NAME)


def _who(entries: Entries, name: str) -> list[str]:
    return list(entries.get(name, {}))


def _of(entries: Entries, node: str) -> list[str]:
    return sorted(name for name, held in entries.items() if node in held)


# -- definitions of types ----------------------------------------------------------------------------------------------


def typedefs(name: str, class_of: Callable[[str], MessageClass]) -> list[TypeDef]:
    """Return the definitions of a message type and of the types in it, each once; empty for a plain number or text.

    Args:
        name: the type.
        class_of: returns the class of a type.

    Raises:
        UsageError: there is no such type.
    """
    found: list[TypeDef] = []
    _collect(name, class_of, found, set())
    return found


def typedefs_of(kind: MessageClass, class_of: Callable[[str], MessageClass]) -> list[TypeDef]:
    """Return the definitions for a class, such as the class of a service's requests."""
    found = [_typedef(kind)]
    seen: set[str] = set()
    for field in found[0]["fieldtypes"]:
        _collect(field, class_of, found, seen)
    return found


def _collect(name: str, class_of: Callable[[str], MessageClass], found: list[TypeDef], seen: set[str]) -> None:
    if name in seen or name in ATOMS:
        return
    seen.add(name)
    made = _time(name) if name in TIMES else _typedef(class_of(name))
    found.append(made)
    for field in made["fieldtypes"]:
        _collect(field, class_of, found, seen)


def _typedef(kind: MessageClass) -> TypeDef:
    message = kind()
    names, types, lengths, examples = list(kind.__slots__), [], [], []
    for name, field in zip(names, kind._slot_types, strict=True):
        base, bracket, rest = field.partition("[")
        types.append(base)
        lengths.append(int(rest[:-1] or 0) if bracket else -1)
        examples.append("[]" if bracket else str(getattr(message, name)) if base in ATOMS else "{}")
    constants = {
        name: value
        for name, value in sorted(vars(kind).items())
        if not name.startswith("_") and name not in names and isinstance(value, (bool, int, float, str))
    }
    return {
        "type": kind._type,
        "fieldnames": names,
        "fieldtypes": types,
        "fieldarraylen": lengths,
        "examples": examples,
        "constnames": list(constants),
        "constvalues": [str(value) for value in constants.values()],
    }


def _time(name: str) -> TypeDef:
    return {
        "type": name,
        "fieldnames": ["secs", "nsecs"],
        "fieldtypes": ["int32", "int32"],
        "fieldarraylen": [-1, -1],
        "examples": ["0", "0"],
        "constnames": [],
        "constvalues": [],
    }
