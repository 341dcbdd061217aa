"""Devices at serial ports and buses of compiled applications: objects in Python, UDP ports, and ROS topics.

A mission file connects them (`devices:`). C reaches them as device files (`api/device_files`) and by the calls of
NOS3's hwlib (`api/hwlib`). All of them exchange bytes in virtual time.
"""

from __future__ import annotations

import re
from collections import deque
from collections.abc import Callable, Mapping
from importlib.util import module_from_spec, spec_from_file_location
from struct import Struct
from typing import TYPE_CHECKING

from cfepy.mission import DeviceConfig
from cfepy.osal import Datagram, Mailbox, Network, Place
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from rospy_shim.graph.outside import OutsideGraph

I2C = "/dev/i2c-"
"""The beginning of the names of I2C buses; the name of a device there ends with ":" and its address."""
PIN = "gpio"
"""The beginning of the names of pins."""
TERMINAL_FUNCTIONS = frozenset(
    (
        *("cfgetispeed", "cfgetospeed", "cfmakeraw", "cfsetispeed", "cfsetospeed", "cfsetspeed", "tcdrain", "tcflush"),
        *("tcgetattr", "tcsetattr"),
    )
)
"""The functions of POSIX that only serve device files."""
_HERE = "127.0.0.1"
STRING = "std_msgs/String"
_LENGTH = Struct("<I")
_DIMENSION = Struct("<II")
"""Size and stride of a MultiArrayDimension, behind its label."""
_NOT_IN_NAMES = re.compile(r"[^A-Za-z0-9_/]")


class Device:
    """A device at a port or bus. Subclasses in a mission's Python files define its answers.

    A serial port calls `write` with the bytes that the application sends, and `read` for bytes to receive. An I2C
    device gets the same calls; it reads exactly the length of the transaction. SPI calls `transfer`. A pin calls
    `write` and `read` with one byte, 0 or 1. A CAN bus exchanges frames of 16 bytes, as Linux's SocketCAN has them.

    Attributes:
        clock: returns the virtual time in s.
    """

    clock: Callable[[], float] = staticmethod(lambda: 0.0)

    def open(self) -> None:
        """Handle the opening of its device file."""

    def write(self, data: bytes) -> None:
        """Take bytes from the application."""

    def read(self, count: int) -> bytes:
        """Return up to `count` bytes for the application; fewer, or none, if the device has no more."""
        return b""

    def waiting(self) -> int:
        """Return the number of bytes that `read` could return now."""
        return 0

    def transfer(self, data: bytes) -> bytes:
        """Exchange bytes on SPI. Returns as many bytes as it gets."""
        self.write(data)
        return self.read(len(data)).ljust(len(data), b"\0")


class UdpDevice(Device):
    """A device that is a program at the other end of UDP: each write is a datagram, and datagrams are bytes to read.

    Args:
        network: the mission's network.
        port: the device's port.
        target: gets the bytes that the application writes.
    """

    def __init__(self, network: Network, port: int, target: Place) -> None:
        self._network = network
        self._place = Place(_HERE, port)
        self._target = target
        self._mailbox = Mailbox()
        self._bytes: deque[int] = deque()
        network.datagrams.bind(self._mailbox, self._place)

    def write(self, data: bytes) -> None:
        self._network.send(Datagram(self._place, self._target, data))

    def read(self, count: int) -> bytes:
        self._receive()
        return bytes(self._bytes.popleft() for _ in range(min(count, len(self._bytes))))

    def waiting(self) -> int:
        self._receive()
        return len(self._bytes)

    def close(self) -> None:
        """Release the port."""
        self._network.datagrams.release(self._mailbox)

    def _receive(self) -> None:
        while not self._mailbox.is_empty:
            self._bytes.extend(self._mailbox.take().data)


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


class DevicePorts:
    """The devices of a mission. An object is made when the processor starts.

    Args:
        configs: the devices, by name.
        network: the mission's network.
        now: returns the virtual time in ns.
        topic_device: makes the devices that are ROS topics; None if there are none.

    Raises:
        UsageError: a file cannot be executed, or has no such class.
    """

    def __init__(
        self,
        configs: Mapping[str, DeviceConfig],
        network: Network,
        now: Callable[[], int],
        topic_device: Callable[[DeviceConfig], Device] | None = None,
    ) -> None:
        self._devices: dict[str, Device] = {}
        self._udp: list[UdpDevice] = []
        for each in configs.values():
            if each.topic and topic_device is not None:
                self._devices[each.name] = topic_device(each)
            elif each.file is None:
                udp = UdpDevice(network, each.port, Place(*each.target))
                self._udp.append(udp)
                self._devices[each.name] = udp
            else:
                self._devices[each.name] = _made(each, lambda: now() / NS_PER_S)

    def __bool__(self) -> bool:
        return bool(self._devices)

    def find(self, name: str) -> Device | None:
        """Return a device."""
        return self._devices.get(name)

    def i2c(self, bus: int, address: int) -> Device | None:
        """Return the device at an address of an I2C bus, whose name has the address as 0x1e or 30."""
        for text in (f"0x{address:02x}", f"0x{address:02X}", str(address)):
            found = self._devices.get(f"{I2C}{bus}:{text}")
            if found is not None:
                return found
        return None

    def buses(self) -> dict[str, Device]:
        """Return the CAN buses: all devices but files and pins."""
        return {name: each for name, each in self._devices.items() if not name.startswith(("/", PIN))}

    def has_file(self, name: str) -> bool:
        """Return True if a device file exists."""
        number = name.removeprefix(I2C)
        return name in self._devices or (name.startswith(I2C) and number.isdecimal() and self.has_bus(int(number)))

    def has_bus(self, bus: int) -> bool:
        """Return True if an I2C bus has devices."""
        return any(each.startswith(f"{I2C}{bus}:") for each in self._devices)

    def close(self) -> None:
        """Release the UDP ports."""
        for each in self._udp:
            each.close()


def _made(config: DeviceConfig, clock: Callable[[], float]) -> Device:
    """Execute the file of a device and make its object."""
    where = f"devices.{config.name}"
    spec = spec_from_file_location(f"cfepy_device_{config.class_name}", str(config.file))
    assert spec is not None
    assert spec.loader is not None
    module = module_from_spec(spec)
    try:
        spec.loader.exec_module(module)
        kind = getattr(module, config.class_name, None)
        if not isinstance(kind, type) or not issubclass(kind, Device):
            text = f"has no class {config.class_name} that is a cfepy.extra.c.Device"
            raise UsageError(text, file=str(config.file), field=where)
        made = kind()
    except UsageError:
        raise
    except Exception as error:
        text = f"{config.class_name} cannot be made: {type(error).__name__}: {error}"
        raise UsageError(text, file=str(config.file), field=where) from error
    made.clock = clock
    return made
