"""cFE applications for ROS outside: packets that are published as topics, and topics that are received for them.

The section `ros_bridge:` of the mission file selects them. Outside, one node represents all applications.

Telemetry with a known layout gets a message type. A number, text, struct or array of a C struct becomes its equivalent
in ROS; an array of arrays becomes one array. It starts with a header (std_msgs/Header) with sequence count and time of
the packet. The bytes need no decoding: ROS serialises numbers as they are, without the padding of C, and a text after
its length (wiki.ros.org/msg).
"""

from __future__ import annotations

import re
import struct
from collections.abc import Callable
from functools import partial
from typing import NamedTuple

from cfepy.ground.dictionary import Dictionary, dictionary_of
from cfepy.ground.topics import Topic
from cfepy.mission import UNIX_AT_CFE_EPOCH, Mission, MissionSpec
from cfepy.msg import TLM_HEADER_SIZE, Cell, Layout, Telemetry
from cfepy.reading.mistakes import each_of
from cfepy.status import UsageError
from cfepy.units import NS_PER_S
from rospy_shim.types.msgs import from_full_text, message_class

APPLICATIONS = "/cfe"  # the node's name
RAW = "std_msgs/UInt8MultiArray"
CLOCK, CLOCK_TYPE = "/clock", "rosgraph_msgs/Clock"
PACKAGE = "cfe_tlm"
RULE = "=" * 80
TOO_SHORT = "a packet is shorter than its layout"
_ROS = {
    **{"u8": "uint8", "i8": "int8", "u16": "uint16", "i16": "int16", "u32": "uint32", "i32": "int32"},
    **{"u64": "uint64", "i64": "int64", "f32": "float32", "f64": "float64", "bool": "bool"},
}
_PART = re.compile(r"(\w+)((?:\[\d+\])*)")
_time = struct.Struct(">IH").unpack_from
_header = struct.Struct("<IIII").pack


class PacketType(NamedTuple):
    """A message type.

    Attributes:
        name: "package/Name".
        md5sum: of its definition.
        definition: its full text, including the types in it.
    """

    name: str
    md5sum: str
    definition: str


class _Struct:
    """Fields of a message in order: the type of a number or text, or another struct; and the indices of arrays."""

    def __init__(self) -> None:
        self.fields: dict[str, str | _Struct] = {}
        self.indices: dict[str, set[str]] = {}

    def add(self, parts: list[tuple[str, str]], kind: str) -> None:
        """Add a number or text, by the parts of its path; an array has the shape of its first item."""
        (name, index), *rest = parts
        indices = self.indices.setdefault(name, set())
        if index:
            indices.add(index)
        if not rest:
            self.fields[name] = kind
        elif len(indices) <= 1:
            inner = self.fields.setdefault(name, _Struct())
            assert isinstance(inner, _Struct)
            inner.add(rest, kind)


def type_of(name: str, layout: Layout) -> PacketType:
    """Return the message type of a telemetry packet.

    Args:
        name: name of the packet.
        layout: layout of its payload.
    """
    texts = definitions_of(name, layout)
    header = f"{RULE}\nMSG: std_msgs/Header\n{message_class('std_msgs/Header')._full_text}"
    first, *others = texts.items()
    definition = first[1] + "".join(f"{RULE}\nMSG: {PACKAGE}/{each}\n{text}" for each, text in others) + header
    full_name = f"{PACKAGE}/{first[0]}"
    made = from_full_text(full_name, definition).message_class(full_name)
    return PacketType(full_name, made._md5sum, definition)


def definitions_of(name: str, layout: Layout) -> dict[str, str]:
    """Return the definitions of that message and of those in it, by their names in the package; the message itself
    comes first.

    Args:
        name: name of the packet.
        layout: layout of its payload.
    """
    main = re.sub(r"\W", "_", name)
    main = main if main[:1].isalpha() else f"P{main}"
    root = _Struct()
    for cell in layout.cells():
        parts = [(part[1], part[2]) for part in map(_PART.fullmatch, cell.path.split(".")) if part is not None]
        root.add(parts, "string" if cell.type.startswith("char") else _ROS[cell.type])
    texts: dict[str, str] = {}
    _write(main, root, texts, "std_msgs/Header header\n")
    return texts


def _write(name: str, shape: _Struct, texts: dict[str, str], lines: str = "") -> None:
    texts[name] = ""
    for field, kind in shape.fields.items():
        if isinstance(kind, _Struct):
            inner = f"{name}_{field}"
            _write(inner, kind, texts)
            kind = f"{PACKAGE}/{inner}"
        count = len(shape.indices[field])
        lines += f"{kind}{f'[{count}]' if count else ''} {field}\n"
    texts[name] = lines


class PacketSerializer:
    """Creates messages from packets.

    Args:
        layout: layout of the payload.
        zero_s: Unix time when spacecraft time is 0, in s.
        header_size: bytes before the payload.
    """

    def __init__(self, layout: Layout, zero_s: int = UNIX_AT_CFE_EPOCH, header_size: int = TLM_HEADER_SIZE) -> None:
        self._zero_s = zero_s
        self._size = header_size + layout.size
        self._pieces = list(_pieces(list(layout.cells()), header_size))

    def message(self, packet: bytes) -> bytes | None:
        """Return the serialised message; None for a packet that is too short."""
        if len(packet) < self._size:
            return None
        seconds, subseconds = _time(packet, 6)
        count = (packet[2] << 8 | packet[3]) & 0x3FFF
        parts = [_header(count, seconds + self._zero_s & 0xFFFFFFFF, subseconds * 1_000_000_000 >> 16, 0)]
        for start, end, is_text in self._pieces:
            data = packet[start:end]
            if is_text:
                data = data.partition(b"\0")[0]
                parts.append(len(data).to_bytes(4, "little"))
            parts.append(data)
        return b"".join(parts)


def _pieces(cells: list[Cell], header_size: int) -> list[tuple[int, int, bool]]:
    """Start, end and whether it is a text, of a contiguous part of a packet."""
    found: list[tuple[int, int, bool]] = []
    for cell in cells:
        start, end, is_text = (
            header_size + cell.offset,
            header_size + cell.offset + cell.size,
            "char" in cell.type,
        )
        if found and not is_text and not found[-1][2] and found[-1][1] == start:
            found[-1] = (found[-1][0], end, False)
        else:
            found.append((start, end, is_text))
    return found


class ShownPacket(NamedTuple):
    """A packet that is published.

    Attributes:
        msg_id: MsgId of the packet.
        type: type of the messages.
        serialize: makes a message from a packet; None for one that is too short.
    """

    msg_id: int
    type: PacketType
    serialize: Callable[[bytes], bytes | None]


class ShownPackets:
    """The section of a mission file.

    Args:
        mission: the mission.

    Attributes:
        packets: published packets, by topic.
        heard: topics that are received for the applications.
        types: types of all topics that are published for them, and of /clock.
        clock_ns: virtual time between two messages of /clock; 0 if it is not published.

    Raises:
        UsageError: if there is no such packet.
    """

    def __init__(self, mission: Mission) -> None:
        spec = mission.spec
        bridge = spec.ros.bridge
        self.heard = bridge.subscribe
        self.packets: dict[str, ShownPacket] = {}
        self.clock_ns = NS_PER_S // bridge.clock_hz if bridge.clock_hz else 0
        if bridge.publish:
            self._read(spec, spec.zero_s(mission.config))
        self.types = {topic: each.type for topic, each in self.packets.items()}
        if self.clock_ns:
            self.types[CLOCK] = _plain_type(CLOCK_TYPE)

    def _read(self, spec: MissionSpec, zero_s: int) -> None:
        bridge = spec.ros.bridge
        dictionary = dictionary_of(spec)
        packets = each_of(partial(_declared, dictionary, spec, topic) for topic in bridge.publish)
        for (topic, (_, is_raw)), found in zip(bridge.publish.items(), packets, strict=True):
            if isinstance(found, Telemetry) and found.payload.size and not is_raw:
                serialize = PacketSerializer(found.payload, zero_s, found.header_size).message
                self.packets[topic] = ShownPacket(found.msg_id, type_of(found.name, found.payload), serialize)
            else:
                self.packets[topic] = ShownPacket(found.msg_id, _plain_type(RAW), _whole)

    def __bool__(self) -> bool:
        return bool(self.types or self.heard)

    def header(self, topic: str) -> dict[str, str] | None:
        """Return the connection header of a topic; None if nothing is published on it."""
        kind = self.types.get(topic)
        if kind is None:
            return None
        fields = {"callerid": APPLICATIONS, "latching": "0", "md5sum": kind.md5sum, "topic": topic}
        return {**fields, "type": kind.name, "message_definition": kind.definition}


def _declared(dictionary: Dictionary, spec: MissionSpec, topic: str) -> Telemetry | Topic:
    """Return the packet that a topic of the bridge shows."""
    try:
        return dictionary.telemetry_of(spec.ros.bridge.publish[topic].packet)
    except UsageError as error:
        file = spec.mission_file or spec.script
        raise UsageError(error.text, file=file, field=f"ros_bridge.publish.{topic}") from None


def _plain_type(name: str) -> PacketType:
    """A type known by ROS."""
    kind = message_class(name)
    return PacketType(name, kind._md5sum, kind._full_text)


def _whole(packet: bytes) -> bytes:
    """Return a message of the packet's bytes: an empty layout, and the data after their length."""
    return bytes(8) + len(packet).to_bytes(4, "little") + packet
