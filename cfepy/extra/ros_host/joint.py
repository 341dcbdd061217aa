"""`Joint`: what nodes and peers ask of the host that joins a mission to ROS, and the mission's part of the graph."""

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
    """Where the mission's nodes are reached: what URIs say, and the interface that listens, "" for all."""

    host: str
    interface: str


class Joint(Protocol):
    """The host, as one outside node or publisher sees it.

    Attributes:
        selector: of all sockets.
        address: where the mission's nodes are reached.
        bounds: what outside programs may use of this process.
        counts: messages and connections by outside node.
        errands: what waits for others, in threads.
        pid: of this process.
        ros: ROS in the mission; None before its first node.
        shown: packets that ROS sees as topics.
        world: what is outside.
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
        """Wall time since some instant."""

    def act(self, name: str, *values: Any) -> Any:
        """Do something to the mission's graph, through the door that a journal has."""

    def ask_inside(self, node: str, body: bytes) -> Answer:
        """A request of the master's or slave API that changes something; `node` is "" for the master."""

    def outer_answer(self, answer: Answer) -> Answer:
        """An answer with the URIs that programs outside know."""

    def name_at(self, uri: str) -> str:
        """The name of the outside node at a URI; "" of one that is unknown."""

    def publication(self, topic: str, name: str) -> dict[str, str] | None:
        """The connection header of a publisher of the mission; None when there is none."""

    def subscription(self, topic: str) -> dict[str, str] | None:
        """The connection header of the mission's subscribers of a topic; None when there are none."""

    def offer(self, service: str, name: str) -> dict[str, str] | None:
        """The connection header of a service of the mission; None when the node does not offer it."""

    def has_room(self, topic: str, publisher: str, payload: bytes) -> bool:
        """Whether the mission takes a message of an outside publisher now."""

    def add_client(self, topic: str, publisher: str, subscriber: str, client: Any) -> None:
        """A subscriber has connected."""

    def remove_client(self, topic: str, publisher: str, subscriber: str, client: Any) -> None:
        """It is gone."""

    def subscribe(self, topic: str, name: str, kind: str, md5sum: str, publisher: str) -> str:
        """Put an outside subscriber on the graph; what is wrong with it."""

    def unsubscribe(self, topic: str, name: str, publisher: str) -> None:
        """One of its connections is gone."""

    def begin_call(self, service: str, caller: str, request: bytes, client: Any) -> int:
        """An outside node calls a service of the mission; the number of the call."""

    def end_call(self, service: str, number: int, caller: str) -> None:
        """The caller is gone."""
