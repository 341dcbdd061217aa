"""The registrations of the master: the mission's present nodes, and entries that programs made themselves.

A program may register publishers, subscribers and services of any URI (registerPublisher and related calls). The master
keeps such an entry, as ROS's does. It brings messages only if the mission is joined to ROS on its computer, and a node
answers at that URI.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

from rospy_shim.types.names import ANYTYPE

if TYPE_CHECKING:
    from rospy_shim.client.node import Node
    from rospy_shim.graph.compiled import CompiledNode
    from rospy_shim.graph.graph import Graph

MOST_TYPES = 20_000  # of topics of others, also of lost ones

Entries = dict[str, dict[str, str]]
"""Names of nodes and their URIs, by topic, service or parameter."""


def uri_of(node: Node | CompiledNode) -> str:
    """Return the URI at which a node answers."""
    return node.client.get_node_uri() or ""


class Registrations:
    """The registrations of a mission's master.

    Args:
        graph: the mission's ROS graph.
    """

    def __init__(self, graph: Graph) -> None:
        self._graph = graph
        self._publishers: Entries = {}
        self._subscribers: Entries = {}
        self._providers: Entries = {}
        self._service_uris: dict[str, str] = {}
        self._types: dict[str, str] = {}
        self._uris: dict[str, str] = {}  # of nodes that were named by hand
        self.param_subscribers: Entries = {}

    # -- queries -------------------------------------------------------------------------------------------------------

    def publishers(self) -> Entries:
        """Return topics with publishers, and their nodes."""
        found = self._of_nodes(
            (name, node) for node in self._nodes() for name, link in node.links.items() if link.topic
        )
        compiled = ((name, node) for node in self._graph.compiled.values() for name in node.published)
        return _merged(_merged(found, self._of_nodes(compiled)), self._publishers)

    def subscribers(self) -> Entries:
        """Return topics with subscribers, and their nodes."""
        pairs = ((name, node) for node in self._nodes() for name, each in node.subscriptions.items() if each.topic)
        compiled = ((name, node) for node in self._graph.compiled.values() for name in node.subscribed)
        return _merged(_merged(self._of_nodes(pairs), self._of_nodes(compiled)), self._subscribers)

    def providers(self) -> Entries:
        """Return offered services, and their nodes."""
        pairs = ((name, entry.service.__node__) for name, entry in self._graph.services.items())
        return {**self._providers, **self._of_nodes(pairs)}

    def topic_types(self) -> dict[str, str]:
        """Return the types of all topics that ever had one."""
        found = {topic.name: topic.type for topic in self._graph.topics.values() if topic.type}
        for name in self.publishers():
            found.setdefault(name, self._types.get(name, ANYTYPE))
        return {**self._types, **found}

    def node_uri(self, name: str) -> str | None:
        """Return the URI of a node; None if it is unknown."""
        node = self._graph.nodes.get(name) or self._graph.compiled.get(name)
        return self._uris.get(name) if node is None else uri_of(node)

    def service_uri(self, name: str) -> str | None:
        """Return the URI of a service; None if it is unknown."""
        entry = self._graph.services.get(name)
        return self._service_uris.get(name) if entry is None else entry.service.uri

    def service_uri_by_hand(self, name: str) -> str | None:
        """Return the URI of a service that its provider has registered; None if it is unknown."""
        return self._service_uris.get(name)

    def _nodes(self) -> Iterator[Node]:
        yield from self._graph.nodes.values()

    def _of_nodes(self, pairs: Iterator[tuple[str, Node | CompiledNode]]) -> Entries:
        found: Entries = {}
        for name, node in pairs:
            found.setdefault(name, {})[node.names.name] = uri_of(node)
        return found

    # -- registrations by hand ---------------------------------------------------------------------------------------

    def register_publisher(self, topic: str, kind: str, caller: str, uri: str) -> None:
        """Register a publisher of a topic."""
        self._enter(self._publishers, topic, caller, uri)
        if kind != ANYTYPE or topic not in self._types:
            self._note_type(topic, kind)

    def register_subscriber(self, topic: str, kind: str, caller: str, uri: str) -> None:
        """Register a subscriber of a topic."""
        self._enter(self._subscribers, topic, caller, uri)
        if kind != ANYTYPE and topic not in self._types:
            self._note_type(topic, kind)

    def _note_type(self, topic: str, kind: str) -> None:
        self._types[topic] = kind
        if len(self._types) > MOST_TYPES:
            del self._types[next(iter(self._types))]

    def register_service(self, service: str, service_uri: str, caller: str, uri: str) -> None:
        """Register a service; the node is its only provider from now on."""
        self._providers.pop(service, None)
        self._enter(self._providers, service, caller, uri)
        self._service_uris[service] = service_uri

    def register_param_subscriber(self, key: str, caller: str, uri: str) -> None:
        """Register a node for changes of a parameter."""
        self._enter(self.param_subscribers, key, caller, uri)

    def _enter(self, entries: Entries, name: str, caller: str, uri: str) -> None:
        """Add an entry; a living node of that name with another URI is replaced, and shut down as in ROS."""
        entries.setdefault(name, {})[caller] = uri
        node = self._graph.nodes.get(caller)
        if node is None:
            self._uris[caller] = uri
        elif uri_of(node).rstrip("/") != uri.rstrip("/"):
            self._uris[caller] = uri
            node.give_way()

    # -- the end of registrations ------------------------------------------------------------------------------------

    def unregister_publisher(self, topic: str, caller: str, uri: str) -> bool:
        """Remove a publisher. Returns False if it was not registered."""
        node = self._living(caller, uri)
        link = node.links.get(topic) if node is not None else None
        if link is not None:
            link.close()
        return self._leave(self._publishers, topic, caller, uri) or link is not None

    def unregister_subscriber(self, topic: str, caller: str, uri: str) -> bool:
        """Remove a subscriber. Returns False if it was not registered."""
        node = self._living(caller, uri)
        subscription = node.subscriptions.get(topic) if node is not None else None
        if subscription is not None:
            subscription.close()
        return self._leave(self._subscribers, topic, caller, uri) or subscription is not None

    def unregister_service(self, service: str, caller: str) -> None:
        """Remove a service."""
        entry = self._graph.services.get(service)
        if entry is not None and entry.service.__node__.names.name == caller:
            entry.service.shutdown("unregistered at the master")
        self._leave(self._providers, service, caller, None)
        self._service_uris.pop(service, None)

    def unregister_param_subscriber(self, key: str, caller: str, uri: str) -> bool:
        """Remove a node from the subscribers of a parameter. Returns False if it was not registered."""
        return self._leave(self.param_subscribers, key, caller, uri)

    def _living(self, caller: str, uri: str) -> Node | None:
        """Return a living node if the URI is the node's, otherwise None."""
        node = self._graph.nodes.get(caller)
        if node is None or uri_of(node).rstrip("/") != uri.rstrip("/"):
            return None
        return node

    def _leave(self, entries: Entries, name: str, caller: str, uri: str | None) -> bool:
        held = entries.get(name, {})
        if caller not in held or (uri is not None and held[caller] != uri):
            return False
        del held[caller]
        if not held:
            del entries[name]
        everything = (self._publishers, self._subscribers, self._providers, self.param_subscribers)
        if not any(caller in held for entries in everything for held in entries.values()):
            self._uris.pop(caller, None)
        return True


def _merged(first: Entries, second: Entries) -> Entries:
    merged = {name: dict(who) for name, who in first.items()}
    for name, who in second.items():
        merged[name] = {**who, **merged.get(name, {})}
    return merged
