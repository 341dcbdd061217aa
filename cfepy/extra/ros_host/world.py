"""`RosWorld`: what is outside of the mission, as its master knows it: one served here, or one that is joined."""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

CALLER = "/cfepy"  # the name under which the host itself asks others


class OwnGraph(NamedTuple):
    """The mission's own part of the graph: nodes with their URIs there; [name, node] of what they do; types of topics.

    `subscribed` has the topics that any of them hears, with the first that does.
    """

    nodes: dict[str, str]
    publishers: list[tuple[str, str]]
    subscribers: list[tuple[str, str]]
    services: list[tuple[str, str]]
    types: dict[str, str]
    subscribed: dict[str, str]


class RosWorld(Protocol):
    """What `RosHost` asks.

    Attributes:
        uri: of the master.
        caller: name under which the host itself asks.
    """

    uri: str
    caller: str

    def begin(self) -> None:
        """The mission stands at virtual time 0; nothing may enter yet.

        Raises:
            UsageError: there is no master to join.
        """

    def enter(self) -> None:
        """The mission's graph is new and empty: the run has begun, or the processor was reset."""

    def look(self, seen: OwnGraph, now_s: float) -> None:
        """See to it that master and mission know of each other's nodes; now and then."""

    def params_changed(self, keys: list[str]) -> None:
        """Parameters of the mission were set or deleted."""

    def heard(self, node: str, method: str, key: Any, value: Any) -> None:
        """The master tells a node of the mission something: `publisherUpdate` or `paramUpdate`."""

    def publishers_of(self, topic: str) -> list[str]:
        """URIs of the outside publishers of a topic."""

    def services(self) -> dict[str, tuple[str, str]]:
        """Outside services: the node, and where it is called."""

    def uri_of(self, name: str) -> str:
        """Where an outside node answers; "" of one that is unknown."""

    def name_at(self, uri: str) -> str:
        """The other way round."""

    def close(self) -> None:
        """The run is over."""
