"""`Joint`: interface of the host that joins a mission to ROS, for nodes and peers; the mission's part of the graph."""

from __future__ import annotations

from selectors import DefaultSelector
from typing import Any, NamedTuple, Protocol

from cfepy.extra.ros_host.errands import Errands
from cfepy.extra.ros_host.world import RosWorld
from cfepy.extra.ros_host.xmlrpc_server import ServerBounds
from cfepy.ground import ShownPackets
from cfepy.io import PeerCounts
from rospy_shim.master.xmlrpc_calls import Answer
from rospy_shim.runtime import RosRuntime


class RosAddress(NamedTuple):
    """The address of the mission's nodes: the host in URIs, and the interface that listens, "" for all."""

    host: str
    interface: str


class Joint(Protocol):
    """The interface of the host for outside nodes and publishers.

    Attributes:
        selector: selector of all sockets.
        address: address of the mission's nodes.
        bounds: limits on the use of this process by external programs.
        counts: messages and connections by outside node.
        errands: background requests to other programs, in threads.
        pid: id of this process.
        ros: ROS in the mission; None before its first node.
        shown: packets that ROS sees as topics.
        world: the external nodes.
        stalled: publishers whose messages wait for room.
    """

    selector: DefaultSelector
    address: RosAddress
    bounds: ServerBounds
    counts: PeerCounts
    errands: Errands
    pid: int
    ros: RosRuntime | None
    shown: ShownPackets
    world: RosWorld
    stalled: set[Any]

    def now_s(self) -> float:
        """Return wall time in s since an arbitrary instant."""

    def act(self, name: str, *values: Any) -> Any:
        """Perform a host action on the mission's graph; a journal records it."""

    def ask_inside(self, node: str, body: bytes) -> Answer:
        """Send a changing request of the master or slave API to the mission; `node` is "" for the master."""

    def outer_answer(self, answer: Answer) -> Answer:
        """Return an answer with the URIs that external programs know."""

    def name_at(self, uri: str) -> str:
        """Return the name of the outside node at a URI; "" if it is unknown."""

    def publication(self, topic: str, name: str) -> dict[str, str] | None:
        """Return the connection header of a publisher of the mission, or None if there is none."""

    def subscription(self, topic: str) -> dict[str, str] | None:
        """Return the connection header of the mission's subscribers of a topic, or None if there are none."""

    def offer(self, service: str, name: str) -> dict[str, str] | None:
        """Return the connection header of a service of the mission, or None if the node does not offer it."""

    def has_room(self, topic: str, publisher: str, payload: bytes) -> bool:
        """Return True if the mission can take a message of an outside publisher now."""

    def add_client(self, topic: str, publisher: str, subscriber: str, client: Any) -> None:
        """Add a subscriber that has connected."""

    def remove_client(self, topic: str, publisher: str, subscriber: str, client: Any) -> None:
        """Remove a subscriber whose connection has ended."""

    def subscribe(self, topic: str, name: str, kind: str, md5sum: str, publisher: str) -> str:
        """Add an outside subscriber to the graph. Returns the error, or ""."""

    def unsubscribe(self, topic: str, name: str, publisher: str) -> None:
        """Remove one of the connections of an outside subscriber."""

    def begin_call(self, service: str, caller: str, request: bytes, client: Any) -> int:
        """Call a service of the mission for an outside node. Returns the number of the call."""

    def end_call(self, service: str, number: int, caller: str) -> None:
        """Drop a call whose caller is gone."""
