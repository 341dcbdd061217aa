"""A device that is a pair of ROS topics: messages of one are bytes to read, and a write is a message on the other."""

from __future__ import annotations

import re
from struct import Struct
from typing import TYPE_CHECKING

from cfepy.extra.c.devices import Device
from cfepy.status import UsageError

if TYPE_CHECKING:
    from collections.abc import Callable

    from cfepy.mission import DeviceConfig
    from rospy_shim.graph.outside import OutsideGraph

STRING = "std_msgs/String"
_LENGTH = Struct("<I")
_DIMENSION = Struct("<II")
"""Size and stride of a MultiArrayDimension, behind its label."""
_NOT_IN_NAMES = re.compile(r"[^A-Za-z0-9_/]")


def bytes_of(payload: bytes, kind: str) -> bytes:
    """Return the bytes in a serialized message of std_msgs/String or std_msgs/UInt8MultiArray."""
    at = 0
    if kind != STRING:
        (count,) = _LENGTH.unpack_from(payload)
        at = _LENGTH.size
        for _ in range(count):
            at += _LENGTH.size + _LENGTH.unpack_from(payload, at)[0] + _DIMENSION.size
        at += _LENGTH.size  # data_offset
    (size,) = _LENGTH.unpack_from(payload, at)
    return payload[at + _LENGTH.size : at + _LENGTH.size + size]


def message_of(data: bytes, kind: str) -> bytes:
    """Return a serialized message with these bytes."""
    layout = b"" if kind == STRING else bytes(2 * _LENGTH.size)  # no dimensions, and no offset
    return layout + _LENGTH.pack(len(data)) + data


class TopicDevice(Device):
    """A device whose other end is a ROS node. It joins the graph when an application opens it.

    Args:
        config: its topics and their type.
        graph: returns the nodes without code in the mission's ROS graph, to which it adds one.
    """

    def __init__(self, config: DeviceConfig, graph: Callable[[], OutsideGraph]) -> None:
        self._config = config
        self._graph = graph
        self._node = "/" + _NOT_IN_NAMES.sub("_", config.name).lstrip("/")
        self._bytes = bytearray()
        self._outside: OutsideGraph | None = None

    def open(self) -> None:
        """Subscribe to the one topic, and advertise the other.

        Raises:
            UsageError: another node has given a topic another type.
        """
        if self._outside is None:
            self._outside = self._graph()
            self._join(self._outside)

    def _join(self, outside: OutsideGraph) -> None:
        from rospy_shim.types.msgs import message_class

        config, made = self._config, message_class(self._config.kind)
        declared = (config.kind, made._md5sum)
        outside.ways_out[self._node] = self
        error = outside.do("subscribe", config.topic, self._node, "", *declared, "")
        if not error:
            self._connect(outside, declared)
        if config.sends and not error:
            error = outside.do("publish", config.sends, self._node, "", *declared, made._full_text, False)
        if error:
            raise UsageError(str(error), field=f"devices.{config.name}")

    def _connect(self, outside: OutsideGraph, declared: tuple[str, str]) -> None:
        """Connect to the publishers that there are, and to later ones at once: no program makes the connections."""
        topic = self._config.topic
        subscription = outside.subscriptions[topic, self._node]
        subscription.connects_itself = False
        for link in subscription.topic.links if subscription.topic is not None else ():
            outside.do("subscribe", topic, self._node, "", *declared, link.node.names.name)

    # -- as a device -------------------------------------------------------------------------------------------------

    def write(self, data: bytes) -> None:
        self.open()
        config = self._config
        if config.sends and self._outside is not None:
            self._outside.links[config.sends, self._node].enter(message_of(data, config.kind))

    def read(self, count: int) -> bytes:
        self.open()
        data = bytes(self._bytes[:count])
        del self._bytes[:count]
        return data

    def waiting(self) -> int:
        return len(self._bytes)

    # -- as the way out of the mission's messages --------------------------------------------------------------------

    def message(self, topic: str, publisher: str, subscriber: str, payload: bytes) -> None:
        """Take a message on its topic."""
        self._bytes += bytes_of(payload, self._config.kind)

    def packet(self, topic: str, packet: bytes) -> None:
        """Ignore packets of applications: none was requested."""

    def request(self, service: str, number: int, header: dict[str, str], body: bytes) -> None:
        """Ignore requests: the node offers no service."""

    def answer(self, number: int, good: bool, body: bytes) -> None:
        """Ignore answers: the node calls no service."""
