"""The master and the parameter server of a mission, with rosmaster's codes and texts.

Source: wiki.ros.org/ROS/Master_API and wiki.ros.org/ROS/Parameter%20Server%20API.
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Iterator
from functools import partial
from typing import TYPE_CHECKING, Any

from rospy_shim.master import xmlrpc_calls as calls
from rospy_shim.master.registrations import Entries, Registrations, uri_of
from rospy_shim.master.xmlrpc_calls import Answer, answers
from rospy_shim.parameters.tree import ParameterTree
from rospy_shim.parameters.values import marshalled
from rospy_shim.types.names import PRIV_NAME, SEP

if TYPE_CHECKING:
    from rospy_shim.client.node import Node
    from rospy_shim.graph.graph import Graph

MASTER_NAME = "/master"
MASTER_PID = 100  # of a process that does not exist


class MasterApi:
    """The master's API; each method takes the caller's name first and returns code, text and value.

    Args:
        graph: the mission's ROS graph.
        uri: URI of the master.

    Attributes:
        registry: publishers, subscribers and services.
    """

    def __init__(self, graph: Graph, uri: str) -> None:
        self._params: ParameterTree = graph.params
        self.registry = Registrations(graph)
        self._uri = uri
        self._graph = graph
        self._updates: dict[str, deque[tuple[str, Any]]] = {}  # by the URI of the node that gets them
        self._params.on_change(self._notify)

    @answers("")
    def getUri(self, caller: str) -> Answer:
        """Return the master's URI."""
        return 1, "", self._uri

    @answers(-1)
    def getPid(self, caller: str) -> Answer:
        """Return a process number."""
        return 1, "", MASTER_PID

    @answers(0, None)
    def shutdown(self, caller: str, reason: str) -> Answer:
        """Refuse: the graph lasts as long as the mission."""
        return 0, "the master ends with the mission", 0

    # -- parameters --------------------------------------------------------------------------------------------------

    @answers(0, calls.text("key"))
    def deleteParam(self, caller: str, key: str) -> Answer:
        """Remove a parameter or a namespace."""
        key = calls.resolve(key, caller)
        try:
            self._params.delete(key)
        except KeyError:
            return -1, f"parameter [{key}] is not set", 0
        return 1, f"parameter {key} deleted", 0

    @answers(0, calls.text("key"), None)
    def setParam(self, caller: str, key: str, value: Any) -> Answer:
        """Set a parameter; a dictionary replaces a namespace."""
        key = calls.resolve(key, caller)
        self._params.set(key, marshalled(value), caller)
        return 1, f"parameter {key} set", 0

    @answers(0, calls.text("key"))
    def getParam(self, caller: str, key: str) -> Answer:
        """Return the value of a parameter, or a namespace."""
        key = calls.resolve(key, caller)
        value = self._params.find(key)
        if value is ParameterTree.MISSING:
            return -1, f"Parameter [{key}] is not set", 0
        return 1, f"Parameter [{key}]", value

    @answers(0, calls.text("key"))
    def searchParam(self, caller: str, key: str) -> Answer:
        """Return the name of the nearest parameter, from the caller's namespace upwards."""
        if key.startswith(PRIV_NAME):
            raise ValueError("invalid key")
        if not caller.startswith(SEP):
            raise ValueError("namespace must be global")
        found: str | None
        if key.startswith(SEP):
            found = key if self._params.find(key) is not ParameterTree.MISSING else None
        else:
            found = self._params.search(caller, key)
        return (
            (1, f"Found [{found}]", found) if found else (-1, f"Cannot find parameter [{key}] in an upwards search", "")
        )

    @answers(0, calls.text("key"))
    def hasParam(self, caller: str, key: str) -> Answer:
        """Return True if there is such a parameter or namespace."""
        key = calls.resolve(key, caller)
        return 1, key, self._params.find(key) is not ParameterTree.MISSING

    @answers([])
    def getParamNames(self, caller: str) -> Answer:
        """Return the names of all parameters."""
        return 1, "Parameter names", self._params.names()

    @answers(0, calls.address("caller_api"), calls.text("key"))
    def subscribeParam(self, caller: str, uri: str, key: str) -> Answer:
        """Return the value of a parameter, and report its changes to the node from now on."""
        key = calls.resolve(key, caller)
        self.registry.register_param_subscriber(key, caller, uri)
        value = self._params.find(key)
        return 1, f"Subscribed to parameter [{key}]", {} if value is ParameterTree.MISSING else value

    @answers(0, calls.address("caller_api"), calls.text("key"))
    def unsubscribeParam(self, caller: str, uri: str, key: str) -> Answer:
        """Unsubscribe from changes of a parameter."""
        key = calls.resolve(key, caller)
        self.registry.unregister_param_subscriber(key, caller, uri)
        return 1, f"Unsubscribe to parameter [{key}]", 1

    def _notify(self, changed: str) -> None:
        """Send a change of a parameter to the nodes that have subscribed to it and that have a cache or a handler.

        All other nodes read the parameters without a call.
        """
        for node in self._graph.nodes.values():
            if node.handler is None and node.params.cache is None:
                continue
            subscribers = self.registry.param_subscribers.items()
            keys = [key for key, uris in subscribers if uri_of(node) in uris.values()]
            keys += node.params.rosout_keys
            is_own = self._params.changed_by == node.names.name
            found = list(_updates(keys, changed, self._params, is_own))
            if found:
                waiting = self._updates.setdefault(uri_of(node), deque())
                waiting += found
                if len(waiting) == len(found):
                    node.start_task("paramUpdate", partial(self._send_updates, node, waiting))

    @staticmethod
    def _send_updates(node: Node, waiting: deque[tuple[str, Any]]) -> None:
        """Send the waiting changes to a node, one after the other."""
        if node.handler is None:
            node.universe.importer.load("rospy.impl.masterslave")
        while waiting:
            key, value = waiting[0]
            try:
                node.handler.paramUpdate(MASTER_NAME, key, node.params.unpacked(value))
            finally:
                waiting.popleft()

    # -- the graph ---------------------------------------------------------------------------------------------------

    @answers("", calls.name("node"))
    def lookupNode(self, caller: str, name: str) -> Answer:
        """Return the URI of a node."""
        uri = self.registry.node_uri(name)
        return (-1, f"unknown node [{name}]", "") if uri is None else (1, "node api", uri)

    @answers("", calls.name_of_thing("service"))
    def lookupService(self, caller: str, service: str) -> Answer:
        """Return the URI of a service."""
        uri = self.registry.service_uri(service)
        return (-1, "no provider", "") if uri is None else (1, f"rosrpc URI: [{uri}]", uri)

    @answers(0, calls.name_or_nothing("subgraph"))
    def getPublishedTopics(self, caller: str, subgraph: str) -> Answer:
        """Return [topic, type] of all published topics below a namespace."""
        prefix = subgraph.rstrip(SEP) + SEP if subgraph else ""
        types = self.registry.topic_types()
        return (
            1,
            "current topics",
            [[each, types[each]] for each in self.registry.publishers() if each.startswith(prefix)],
        )

    @answers([])
    def getTopicTypes(self, caller: str) -> Answer:
        """Return [topic, type] of all topics so far."""
        return 1, "current system state", [list(each) for each in self.registry.topic_types().items()]

    @answers([[], [], []])
    def getSystemState(self, caller: str) -> Answer:
        """Return publishers, subscribers and providers of services: three lists of [name, [node, ...]]."""
        known = self.registry
        entries = (known.publishers(), known.subscribers(), known.providers())
        return 1, "current system state", [[[name, list(who)] for name, who in each.items()] for each in entries]

    # -- registrations by hand; the mission's nodes need none --------------------------------------------------------

    @answers([], calls.name_of_thing("topic"), calls.type_name("topic_type"), calls.address("caller_api"))
    def registerPublisher(self, caller: str, topic: str, kind: str, uri: str) -> Answer:
        """Register a publisher. The value is the list of the subscribers' URIs."""
        self.registry.register_publisher(topic, kind, caller, uri)
        return 1, f"Registered [{caller}] as publisher of [{topic}]", _uris(self.registry.subscribers(), topic)

    @answers([], calls.name_of_thing("topic"), calls.type_name("topic_type"), calls.address("caller_api"))
    def registerSubscriber(self, caller: str, topic: str, kind: str, uri: str) -> Answer:
        """Register a subscriber. The value is the list of the publishers' URIs."""
        self.registry.register_subscriber(topic, kind, caller, uri)
        return 1, f"Subscribed to [{topic}]", _uris(self.registry.publishers(), topic)

    @answers(0, calls.name_of_thing("service"), calls.address("service_api"), calls.address("caller_api"))
    def registerService(self, caller: str, service: str, service_uri: str, uri: str) -> Answer:
        """Register the provider of a service."""
        self.registry.register_service(service, service_uri, caller, uri)
        return 1, f"Registered [{caller}] as provider of [{service}]", 1

    @answers(0, calls.name_of_thing("topic"), calls.address("caller_api"))
    def unregisterPublisher(self, caller: str, topic: str, uri: str) -> Answer:
        """Unregister a publisher; the node's own messages are not delivered any more."""
        known = self._is_known(caller)
        return _unregistered(known, self.registry.unregister_publisher(topic, caller, uri), caller, topic)

    @answers(0, calls.name_of_thing("topic"), calls.address("caller_api"))
    def unregisterSubscriber(self, caller: str, topic: str, uri: str) -> Answer:
        """Unregister a subscriber; the node gets no more messages of the topic."""
        known = self._is_known(caller)
        return _unregistered(known, self.registry.unregister_subscriber(topic, caller, uri), caller, topic)

    @answers(0, calls.name_of_thing("service"), calls.address("service_api"))
    def unregisterService(self, caller: str, service: str, service_uri: str) -> Answer:
        """Unregister the provider of a service, which cannot be called any more."""
        if not self._is_known(caller):
            return 1, f"[{caller}] is not a registered node", 0
        providers = self.registry.providers().get(service, {})
        if caller not in providers or self.registry.service_uri(service) != service_uri:
            return 1, f"[{service_uri}] is no longer the current service api handle for [{service}]", 0
        self.registry.unregister_service(service, caller)
        return 1, f"Unregistered [{caller}] as provider of [{service}]", 1

    def _is_known(self, caller: str) -> bool:
        return self.registry.node_uri(caller) is not None


def _uris(entries: Entries, name: str) -> list[str]:
    return list(entries.get(name, {}).values())


def _unregistered(known: bool, done: bool, caller: str, topic: str) -> Answer:
    if not known:
        return 1, f"[{caller}] is not a registered node", 0
    if not done:
        return 1, f"[{caller}] is not a known provider of [{topic}]", 0
    return 1, f"Unregistered [{caller}] as provider of [{topic}]", 1


def _updates(keys: Iterable[str], changed: str, params: ParameterTree, is_own: bool) -> Iterator[tuple[str, Any]]:
    """Yield the keys, with a slash at the end, and values that ROS's master sends to a node after a change.

    It sends the changed key if it is a subscribed one or below it, but not to a node that set it itself. It sends the
    subscribed key if it is below a namespace that was set or deleted, but not if a value has replaced the namespace.

    Args:
        keys: the subscribed keys.
        changed: the changed key.
        params: all parameters.
        is_own: whether the node set the changed key.
    """
    whole = changed.rstrip(SEP) + SEP
    value = params.find(changed)
    is_deleted = value is ParameterTree.MISSING
    for key in keys:
        inner = key.rstrip(SEP) + SEP
        if whole.startswith(inner):
            if is_deleted or not is_own:
                yield whole, {} if is_deleted else value
        elif inner.startswith(whole) and (is_deleted or type(value) is dict):
            yield inner, _value_or_nothing(params, key)


def _value_or_nothing(params: ParameterTree, key: str) -> Any:
    value = params.find(key)
    return {} if value is ParameterTree.MISSING else value
