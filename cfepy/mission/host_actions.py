"""Acts: what a test or another program itself does to a mission, while the run stands still.

Acts are plain values that go through `cfepy.mission.outside`, so a journal has them and a replay does them again.
"""

from __future__ import annotations

import weakref
from collections.abc import Callable
from typing import TYPE_CHECKING, Any, Protocol

from cfepy.app import Cfe
from cfepy.osal import FileSystem

if TYPE_CHECKING:
    from rospy_shim.runtime import RosRuntime

PACKET, PUBLISH, PARAM, CALL, FILE, ROS = "packet", "publish", "param", "call", "file", "ros"


class ActedOn(Protocol):
    """What acts need of a mission; after a reset its properties give those of the new processor."""

    files: FileSystem

    @property
    def cfe(self) -> Cfe:
        """The services."""

    @property
    def ros(self) -> RosRuntime | None:
        """The ROS side; None before the first node started."""

    def begin_ros(self) -> RosRuntime:
        """The ROS side, made if there was no node yet."""


class HostCall:
    """A service call under way.

    Attributes:
        response: None as long as there is none.
        error: what went wrong instead.
    """

    def __init__(self) -> None:
        self.response: Any = None
        self.error: Exception | None = None

    def make(self, proxy: Any, request: Any) -> None:
        """Call, in a task of the mission."""
        try:
            self.response = proxy(request)
        except Exception as error:  # whatever goes wrong is what the caller wants to know
            self.error = error

    @property
    def over(self) -> bool:
        """Whether it has ended, well or not."""
        return self.response is not None or self.error is not None


class HostActs:
    """Does acts.

    Args:
        mission: the mission, also after it was reset; it is not kept.
    """

    def __init__(self, mission: ActedOn) -> None:
        self._reference = weakref.ref(mission)
        self._acts: dict[str, Callable[..., Any]] = {
            PACKET: self._packet,
            PUBLISH: self._publish,
            PARAM: self._param,
            CALL: self._call,
            FILE: mission.files.write_file,
            ROS: self._outside_nodes,
        }

    def do(self, name: str, *values: Any) -> Any:
        """Do one.

        Args:
            name: ROS is what a ROS node outside of the mission does (name, values, as `OutsideGraph.do`; without any
                the ROS side begins); PACKET puts one on the bus as it is (data); PUBLISH a message on a ROS topic
                (topic, data); PARAM sets a ROS parameter (name, value); CALL begins to call a ROS service (name,
                request), which the run goes on with; FILE writes one (path, data).
            values: plain, as above; messages as ROS serialises them.

        Raises:
            KeyError: there is no such act, topic or service.
            CfeError: the bus refuses a packet.
        """
        return self._acts[name](*values)

    @property
    def _mission(self) -> ActedOn:
        mission = self._reference()
        assert mission is not None  # who acts on it has it
        return mission

    @property
    def _ros(self) -> RosRuntime:
        ros = self._mission.ros
        if ros is None:
            raise KeyError("no ROS node has started")
        return ros

    def _outside_nodes(self, *values: Any) -> Any:
        outside = self._mission.begin_ros().outside
        return outside.do(*values) if values else None

    def _packet(self, data: bytes) -> None:
        self._mission.cfe.sb.transmit_msg(data, is_origination=False)

    def _publish(self, name: str, data: bytes) -> None:
        """Long messages go out in segments, as a node sends them."""
        from rospy_shim.types.transport import HEADER_BYTES, segments, whole_header

        topic, bus = self._ros.graph.topics[name], self._mission.cfe.sb
        room = bus.config.sb_max_msg_size - HEADER_BYTES
        if len(data) <= room:
            bus.transmit_msg(whole_header(topic.msg_id) + data)
            return
        packets = list(segments(topic.msg_id, data, room))
        for subscription in topic.subscriptions:
            subscription.expect_segments(len(packets))
        for packet in packets:
            bus.transmit_msg(packet)

    def _param(self, name: str, value: Any) -> None:
        self._ros.graph.params.set(name, value)

    def _call(self, name: str, request: bytes) -> HostCall:
        """Call from a task of a node that is there already; see `Graph.caller`."""
        node, service_class = self._ros.graph.caller(name)
        call, message = HostCall(), service_class._request_class().deserialize(request)
        proxy = node.ServiceProxy(name, service_class)
        node.start_task("host", lambda: call.make(proxy, message))
        return call
