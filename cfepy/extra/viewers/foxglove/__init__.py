"""`--foxglove`: the mission in Foxglove, live, over its WebSocket protocol (docs.foxglove.dev, "Foxglove WebSocket").

A module belongs here if it translates between the mission and Foxglove's protocol.

`FoxgloveViewer` watches the bus, as a recording does, so viewers do not change the trace of a run. Input enters while
the run stands still, through `cfepy.mission.outside`. So a journal records it, and a replay needs no viewer.
"""

from __future__ import annotations

import time
from typing import TYPE_CHECKING

from cfepy.extra.viewers.foxglove.client_topics import ClientTopics
from cfepy.extra.viewers.foxglove.graph_mirror import GraphMirror, ParameterMirror, ServiceMirror
from cfepy.extra.viewers.foxglove.protocol import (
    Advertised,
    Called,
    Op,
    ParametersSet,
    Published,
    Unadvertised,
    parameters,
)
from cfepy.extra.viewers.foxglove.shown_channels import ShownChannels
from cfepy.extra.viewers.foxglove.viewer import PEER, Viewer
from cfepy.extra.viewers.foxglove.viewer_server import ViewerServer
from cfepy.extra.viewers.listen import Admission, ListenPlace
from cfepy.extra.viewers.websocket_listener import TABLE
from cfepy.ground import TOO_SHORT, Dictionary, ShownPackets, dictionary_of
from cfepy.io import OUT_OF, PeerCounts
from cfepy.mission import Mission, Seen, TopicMessage, TopicWatch
from cfepy.msg import get_header_version

if TYPE_CHECKING:
    from rospy_shim.runtime import RosRuntime

__all__ = ["FoxgloveViewer"]

LOOK_S = 0.05  # wall time between two looks at the graph


class FoxgloveViewer(TopicWatch):
    """A server for Foxglove. Attach it to the mission, join it to the host, and close it when the run is over.

    Args:
        place: the address at which viewers connect.
        admission: decides which viewers may connect.
        name: name of the mission; viewers show it.
        counts: counts for the run's report.

    Attributes:
        place: the address at which viewers connect, with the actual port.

    Raises:
        UsageError: the package websockets is not installed, or the port is taken.
    """

    def __init__(self, place: ListenPlace, admission: Admission, name: str, counts: PeerCounts) -> None:
        super().__init__(lambda message: self._channels.show_message(message))
        self._counts = counts
        self._dictionary = Dictionary()
        self._ros: RosRuntime | None = None
        self._look_at_s = 0.0
        self._server = ViewerServer(place, admission, name, counts, self._do, self._gone)
        self._parameters = ParameterMirror(self._server)
        self._services = ServiceMirror(self._server)
        self._graph_shown = GraphMirror(self._server)
        self._incoming: ClientTopics | None = None
        self.place = self._server.place

    # -- the mission -------------------------------------------------------------------------------------------------

    def begin(self, mission: Mission) -> None:
        super().begin(mission)
        mission.record.tables[TABLE] = self._counts.rows
        self._dictionary = dictionary_of(mission.spec)
        self._channels = ShownChannels(self._server, self._dictionary, self._counts)
        self._shown = shown = ShownPackets(mission)
        self._shown_as: dict[int, list[str]] = {}
        for topic, packet in shown.packets.items():
            self._shown_as.setdefault(packet.msg_id, []).append(topic)
            self._channels.announce(topic, shown.header(topic) or {})
        self._incoming = ClientTopics(mission, self._dictionary, self._counts, self, self._server.tell_problem)

    def _is_wanted(self, msg_id: int) -> bool:
        return True

    def take_packet(self, seen: Seen) -> None:
        super().take_packet(seen)
        for topic in self._shown_as.get(seen.msg_id, ()):
            self._show_as(topic, seen)
        declared = None if get_header_version(seen.packet) else self._dictionary.declared_as(seen.packet)
        if declared is None and self._topic(seen.msg_id) is not None:
            return  # the message of a ROS topic, which has been shown
        self._channels.show_packet(seen, declared, self._stamp(seen.at_ns) or 0)

    def _show_as(self, topic: str, seen: Seen) -> None:
        """Show the packet of an application as the message that the mission file defines for it."""
        header = self._shown.header(topic) or {}
        if not self._channels.announce(topic, header).is_heard:
            return
        payload = self._shown.packets[topic].serialize(seen.packet)
        if payload is None:
            row = self._counts.of(topic, PEER, OUT_OF)
            row.dropped += 1
            row.why = TOO_SHORT
        else:
            self._channels.show_message(TopicMessage(topic, header, payload, seen.at_ns, self._stamp(seen.at_ns)))

    # -- the host ----------------------------------------------------------------------------------------------------

    def fileno(self) -> int:
        """Return the descriptor that becomes readable when input arrives."""
        return self._server.fileno()

    def exchange(self) -> None:
        """Bring in the input that arrived, and show news, while the run stands still."""
        mission, incoming = self._mission, self._incoming
        assert mission is not None
        assert incoming is not None
        if mission.ros is not self._ros:
            self._ros = mission.ros
            self._begin_ros()
        self._server.exchange()
        incoming.enter()
        self._parameters.look()
        now_s = time.monotonic()
        if now_s >= self._look_at_s:
            self._look_at_s = now_s + LOOK_S
            self._look(mission)

    def close(self) -> None:
        """Send the last messages, and end all connections at the end of the run. You may call it more than once."""
        self._incoming = None  # viewers that leave now have nothing left in the mission
        self._services.forget("the run is over")
        self._server.close()

    def _begin_ros(self) -> None:
        ros = self._ros
        self._services.forget("the service has ended")
        if ros is not None:
            assert self._incoming is not None
            self._parameters.watch(ros.graph.params)
            self._incoming.begin()

    def _do(self, viewer: Viewer, op: Op) -> None:
        mission, incoming = self._mission, self._incoming
        if mission is None or incoming is None:
            return  # the run has not begun, or is over
        match op:
            case Advertised():
                incoming.advertise(viewer, op)
            case Unadvertised():
                for number in op.numbers:
                    incoming.unadvertise(viewer, number)
            case Published():
                incoming.publish(viewer, op)
            case ParametersSet():
                self._parameters.set(mission, op)
                if op.request is not None:
                    values = self._server.values
                    viewer.tell(parameters([(name, values.get(name)) for name in op.values], op.request))
            case Called():
                self._services.begin(mission, viewer, op, self)

    def _gone(self, viewer: Viewer) -> None:
        self._services.gone(viewer)
        if self._incoming is not None:
            self._incoming.gone(viewer)

    def _look(self, mission: Mission) -> None:
        self._server.tell_time(self._stamp(mission.kernel.now) or 0)
        ros = self._ros
        if ros is None:
            return
        for topic in list(ros.graph.topics.values()):
            if topic.md5sum not in ("", "*") and topic.definition and not topic.raw:
                about = {"type": topic.type, "md5sum": topic.md5sum, "message_definition": topic.definition}
                self._channels.announce(topic.name, about)
        self._services.look(ros.graph)
        self._graph_shown.look(ros.graph)

    # -- output to the nodes that stand for viewers --------------------------------------------------------------------

    def message(self, topic: str, publisher: str, subscriber: str, payload: bytes) -> None:
        """Do nothing: viewers watch the bus, and subscribe to nothing in the graph."""

    def packet(self, topic: str, packet: bytes) -> None:
        """Do nothing: viewers watch the bus, and subscribe to nothing in the graph."""

    def request(self, service: str, number: int, header: dict[str, str], body: bytes) -> None:
        """Do nothing: viewers offer no services."""

    def answer(self, number: int, good: bool, body: bytes) -> None:
        self._services.answer(number, good, body)
