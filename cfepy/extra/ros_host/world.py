"""`RosWorld`: the external nodes, as known to the mission's master, which is served here or joined."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

CALLER = "/cfepy"  # the node name of the host itself


class OwnGraph(NamedTuple):
    """The mission's own part of the graph: nodes with their internal URIs, (name, node) of publishers, subscribers and
    services, and types of topics.

    `subscribed` has the topics with a subscriber in the mission, and the first of its subscribers.
    """

    nodes: dict[str, str]
    publishers: list[tuple[str, str]]
    subscribers: list[tuple[str, str]]
    services: list[tuple[str, str]]
    types: dict[str, str]
    subscribed: dict[str, str]


class RosWorld(Protocol):
    """The interface of the external nodes for `RosHost`.

    Attributes:
        uri: URI of the master.
        caller: node name of the host itself.
    """

    uri: str
    caller: str

    def begin(self) -> None:
        """Begin, while the mission stands at virtual time 0; input may not enter yet.

        Raises:
            UsageError: there is no master to join.
        """

    def enter(self) -> None:
        """Fill the mission's graph, which is new and empty: the run has begun, or the processor was reset."""

    def look(self, seen: OwnGraph, now_s: float) -> None:
        """Let master and mission learn of each other's nodes; called at intervals."""

    def params_changed(self, keys: list[str]) -> None:
        """Publish parameters of the mission that were set or deleted."""

    def heard(self, node: str, method: str, key: Any, value: Any) -> None:
        """Take a notification of the master for a node of the mission: `publisherUpdate` or `paramUpdate`."""

    def publishers_of(self, topic: str) -> list[str]:
        """Return the URIs of the outside publishers of a topic."""

    def services(self) -> dict[str, tuple[str, str]]:
        """Return the outside services: the node and the URI of each."""

    def uri_of(self, name: str) -> str:
        """Return the URI of an outside node; "" if it is unknown."""

    def name_at(self, uri: str) -> str:
        """Return the name of the outside node at a URI; "" if it is unknown."""

    def close(self) -> None:
        """Close at the end of the run."""
