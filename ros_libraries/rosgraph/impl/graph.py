"""rosgraph.impl.graph: a picture of the ROS graph, nodes and topics with the edges between them, kept up to date.

In the picture, a topic is a node whose name begins with a space, to distinguish it from a node of that name.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Iterable, Iterator
from typing import Any
from xmlrpc.client import ServerProxy

from rosgraph.masterapi import Master, MasterException

_NAME = "/rosviz"


def topic_node(topic: str) -> str:
    """Return the name of a topic in the picture."""
    return " " + topic


def node_topic(node: str) -> str:
    """Return the topic of such a name."""
    return node[1:]


class BadNode:
    """A node that does not answer.

    Args:
        name: name of the node.
        type: DEAD, or WONKY if it has been asked again.
        reason: the error.
    """

    DEAD = 0
    WONKY = 1

    def __init__(self, name: str, type: int, reason: str) -> None:
        self.name = name
        self.type = type
        self.reason = reason


class Edge:
    """An arrow from one name to another.

    Args:
        start: where it begins.
        end: where it ends.
        label: name of the topic, for an arrow between nodes.
    """

    __slots__ = ["end", "key", "label", "rkey", "start"]

    def __init__(self, start: str, end: str, label: str = "") -> None:
        self.start = start
        self.end = end
        self.label = label
        self.key = f"{start}|{label}"
        self.rkey = f"{end}|{label}"

    def __str__(self) -> str:
        return f"{self.start}->{self.end}"

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Edge) and (self.start, self.end) == (other.start, other.end)

    __hash__ = None  # type: ignore[assignment]  # as edges of ROS, which are compared only


def edge_args(start: str, dest: str, direction: str, label: str) -> list[tuple[str, str, str]]:
    """Return the arguments of the edges between two names, in the direction "i", "o" or "b" (both) as seen from the
    first."""
    edges = {"o": [(start, dest, label)], "i": [(dest, start, label)]}
    return edges.get(direction, []) if direction != "b" else edges["o"] + edges["i"]


class EdgeList:
    """Edges, by where they begin and where they end."""

    __slots__ = ["edges_by_end", "edges_by_start"]

    def __init__(self) -> None:
        self.edges_by_start: dict[str, list[Edge]] = {}
        self.edges_by_end: dict[str, list[Edge]] = {}

    def __iter__(self) -> Iterator[Edge]:
        return itertools.chain.from_iterable(self.edges_by_start.values())

    def __contains__(self, edge: Edge) -> bool:
        return edge in self.edges_by_start.get(edge.key, [])

    def has(self, edge: Edge) -> bool:
        """Return whether an edge is there."""
        return edge in self

    def add(self, edge: Edge) -> bool:
        """Add an edge. Returns whether it is new."""
        starting = self.edges_by_start.setdefault(edge.key, [])
        if edge in starting:
            return False
        starting.append(edge)
        self.edges_by_end.setdefault(edge.rkey, []).append(edge)
        return True

    def add_edges(self, start: str | None, dest: str | None, direction: str, label: str = "") -> bool:
        """Add the edges between two names. Returns whether any is new. None stands for an unknown name."""
        if not start or not dest:
            return False
        return sum(self.add(Edge(*args)) for args in edge_args(start, dest, direction, label)) > 0

    def delete(self, edge: Edge) -> None:
        """Remove an edge."""
        for edges, key in ((self.edges_by_start, edge.key), (self.edges_by_end, edge.rkey)):
            if edge in edges.get(key, []):
                edges[key].remove(edge)

    def delete_all(self, node: str) -> None:
        """Remove all edges that begin or end at a name."""
        for edge in [edge for edge in self if node in (edge.start, edge.end)]:
            self.delete(edge)


class Graph:
    """The picture; `update` asks the master and the nodes again.

    Args:
        node_ns: only nodes whose names begin so.
        topic_ns: only topics whose names begin so.
    """

    def __init__(self, node_ns: str = "/", topic_ns: str = "/") -> None:
        self.master = Master(_NAME)
        self.node_ns = node_ns or "/"
        self.topic_ns = topic_ns or "/"
        self.nn_nodes: set[str] = set()
        self.nt_nodes: set[str] = set()
        self.srvs: set[str] = set()
        self.bad_nodes: dict[str, BadNode] = {}
        self.nn_edges = EdgeList()
        self.nt_edges = EdgeList()
        self.nt_all_edges = EdgeList()
        self.node_uri_map: dict[str, str] = {}
        self.uri_node_map: dict[str, str] = {}
        self.last_master_refresh = 0.0
        self.last_node_refresh: dict[str, float] = {}
        self.master_stale = 5.0
        self.node_stale = 5.0

    def set_master_stale(self, stale_secs: float) -> None:
        """Set how long, in seconds, the master's answer counts as fresh."""
        self.master_stale = stale_secs

    def set_node_stale(self, stale_secs: float) -> None:
        """Set how long, in seconds, a node's answer counts as fresh."""
        self.node_stale = stale_secs

    def update(self) -> bool:
        """Ask the master and the nodes whose answers are old. Returns whether anything has changed."""
        updated = False
        if time.time() > self.last_master_refresh + self.master_stale:
            updated = self._refresh_master()
            self.last_master_refresh = time.time()
        return self._refresh_nodes(sorted(self.nn_nodes - self.bad_nodes.keys())) or updated

    def bad_update(self) -> bool:
        """Ask the nodes that did not answer. Returns whether anything has changed."""
        return self._refresh_nodes(sorted(self.bad_nodes))

    def _refresh_nodes(self, names: Iterable[str]) -> bool:
        updated = False
        for name in names:
            if time.time() > self.last_node_refresh.get(name, 0.0) + self.node_stale:
                updated = self._refresh_node(name) or updated
                self.last_node_refresh[name] = time.time()
        return updated

    def _refresh_master(self) -> bool:
        try:
            publishers, subscribers, services = self.master.getSystemState()
        except MasterException:
            return False
        updated, nodes = False, set[str]()
        for state, direction in ((publishers, "o"), (subscribers, "i")):
            for topic, names in state:
                if topic.startswith(self.topic_ns):
                    nodes.update(name for name in names if name.startswith(self.node_ns))
                    self.nt_nodes.add(topic_node(topic))
                    for name in names:
                        updated = self.nt_all_edges.add_edges(name, topic_node(topic), direction) or updated
        for name in sorted(self.nn_nodes - nodes):
            for edges in (self.nn_edges, self.nt_edges, self.nt_all_edges):
                edges.delete_all(name)
        now = (nodes, {service for service, _ in services})
        updated = updated or now != (self.nn_nodes, self.srvs)
        self.nn_nodes, self.srvs = now
        for name in sorted(nodes):
            self._look_up(name)
        return updated

    def _look_up(self, name: str) -> str | None:
        try:
            uri = str(self.master.lookupNode(name))
        except MasterException:
            return None
        self.node_uri_map[name] = uri
        self.uri_node_map[uri] = name
        return uri

    def _refresh_node(self, name: str) -> bool:
        """Ask a node for its connections."""
        uri = self._look_up(name)
        if uri is None:
            return False
        try:
            api: Any = ServerProxy(uri)
            _, _, connections = api.getBusInfo(_NAME)
        except Exception as error:
            self.bad_nodes[name] = BadNode(name, BadNode.DEAD, str(error))
            return False
        if name in self.bad_nodes:
            self.bad_nodes[name].type = BadNode.WONKY
        return sum(self._add_connection(name, *each[1:6]) for each in connections if len(each) > 5) > 0

    def _add_connection(
        self, name: str, dest: str, direction: str, transport: str, topic: str, connected: bool
    ) -> bool:
        if not connected or not topic.startswith(self.topic_ns):
            return False
        self.nt_nodes.add(topic_node(topic))
        updated = self.nt_edges.add_edges(name, topic_node(topic), direction)
        if dest.startswith("http://"):
            updated = self.nn_edges.add_edges(name, self.uri_node_map.get(dest), direction, topic) or updated
        return updated
