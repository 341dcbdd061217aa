"""Host actions: publish, set a parameter, call a service or write a file while the mission is paused.

Host actions are plain values that pass through `cfepy.mission.outside`. So a journal records them, and a replay repeats
them.
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
    """The parts of a mission that host actions need; after a reset the properties return those of the new processor."""

    files: FileSystem

    @property
    def cfe(self) -> Cfe:
        """The services."""

    @property
    def ros(self) -> RosRuntime | None:
        """The ROS side; None before the first node has started."""

    def begin_ros(self) -> RosRuntime:
        """Return the ROS side, and create it if there was no node yet."""


class HostCall:
    """A service call in progress.

    Attributes:
        response: the response; None before it arrives.
        error: the error instead of a response.
    """

    def __init__(self) -> None:
        self.response: Any = None
        self.error: Exception | None = None

    def make(self, proxy: Any, request: Any) -> None:
        """Make the call in a task of the mission."""
        try:
            self.response = proxy(request)
        except Exception as error:  # the caller needs to know every error
            self.error = error

    @property
    def over(self) -> bool:
        """Whether the call has ended, with a response or an error."""
        return self.response is not None or self.error is not None


class HostActs:
    """Performs host actions on a mission.

    Args:
        mission: the mission; it may be reset. Only a weak reference is kept.
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
        """Perform a host action.

        Args:
            name: PACKET puts a packet on the bus unchanged (data). PUBLISH publishes a message on a ROS topic (topic,
                data). PARAM sets a ROS parameter (name, value). CALL starts a ROS service call (name, request), which
                continues with the run. FILE writes a file (path, data). ROS performs an action of an external ROS node
                (name, values; see `OutsideGraph.do`), or starts the ROS side without values.
            values: plain values, as above; messages in ROS serialization.

        Raises:
            KeyError: if the action, topic or service does not exist.
            CfeError: if the bus refuses a packet.
        """
        return self._acts[name](*values)

    @property
    def _mission(self) -> ActedOn:
        mission = self._reference()
        assert mission is not None  # the caller holds a reference
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
        """Publish a message; long messages are sent in segments, as a node sends them."""
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
        """Start a call from a task of an existing node; see `Graph.caller`."""
        node, service_class = self._ros.graph.caller(name)
        call, message = HostCall(), service_class._request_class().deserialize(request)
        proxy = node.ServiceProxy(name, service_class)
        node.start_task("host", lambda: call.make(proxy, message))
        return call
