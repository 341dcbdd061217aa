"""Records of an MCAP file (mcap.dev/spec): an opcode, a length and a body, all in little endian.

They are read from bytes by own code. It reports the byte at which a file violates the format, trusts no length before
verifying it, and continues after damaged parts. Imports what the package has.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from . import compression
from .contents import Connection
from .errors import ROSBagFormatException
from .md5sums import md5sum_of
from .records import Buffer

MAGIC = b"\x89MCAP0\r\n"
HEADER, FOOTER, SCHEMA, CHANNEL, MESSAGE, CHUNK, MESSAGE_INDEX, CHUNK_INDEX = range(1, 9)
ATTACHMENT, ATTACHMENT_INDEX, STATISTICS, METADATA, METADATA_INDEX, SUMMARY_OFFSET, DATA_END = range(9, 16)
PREFIX = struct.Struct("<BQ")
MESSAGE_HEAD = struct.Struct("<HIQQ")
CHUNK_HEAD = struct.Struct("<QQQII")
LARGEST_TEXT = 64 << 20  # bytes of a record other than a message, chunk or attachment
_uint16, _uint32, _uint64 = struct.Struct("<H"), struct.Struct("<I"), struct.Struct("<Q")
_KINDS = {"": compression.NONE, "lz4": compression.LZ4, "zstd": compression.ZSTD}

ROS1, ROS1_SCHEMA = "ros1", "ros1msg"
_LATCHING = {"1": "true", "0": "false"}
"""How the profile ros1 has what a connection header says of latching."""
_LATCHING_BACK = {value: key for key, value in _LATCHING.items()}


class McapSchema(NamedTuple):
    """The type of a channel's messages: a name, the encoding of the definition, and the definition."""

    name: str
    encoding: str
    data: bytes


NO_SCHEMA = McapSchema("", "", b"")


@dataclass(eq=False)
class RecordedChannel:
    """A channel of a recording: of an MCAP file, or a connection of a bag.

    Attributes:
        id: number in the file.
        topic: name.
        encoding: encoding of its messages, such as "ros1" or "json".
        schema: schema of its messages.
        metadata: further data; for a topic of ROS 1 the fields of the connection header.
        connection: its connection of ROS 1, or None if it is of another kind.
    """

    id: int
    topic: str
    encoding: str
    schema: McapSchema
    metadata: Mapping[str, str] = field(default_factory=dict)
    connection: Connection | None = None


class RecordedMessage(NamedTuple):
    """A message of a recording; times in ns."""

    channel: RecordedChannel
    time: int
    data: bytes
    publish_time: int
    sequence: int = 0


class ChunkRecord(NamedTuple):
    """A chunk: times of its first and last message in ns, and how its records are kept.

    `data_at` is where they begin in the body of the record, `stored_size` their bytes there.
    """

    start: int
    end: int
    size: int
    crc: int
    kind: str
    data_at: int
    stored_size: int


class Body:
    """Reads the body of a record.

    Args:
        data: the bytes.
        place: where they begin in the file, for errors.
    """

    def __init__(self, data: Buffer, place: int) -> None:
        self.data, self.place = data, place
        self.at = 0

    def wrong(self, what: str) -> ROSBagFormatException:
        """Return an error with this position."""
        return ROSBagFormatException(f"{what} at byte {self.place + self.at:,}")

    def take(self, size: int) -> bytes:
        """So many bytes."""
        end = self.at + size
        if end > len(self.data):
            raise self.wrong(f"a record ends in the middle of {size:,} bytes")
        found = bytes(self.data[self.at : end])
        self.at = end
        return found

    def _number(self, layout: struct.Struct) -> int:
        return int(layout.unpack(self.take(layout.size))[0])

    def uint16(self) -> int:
        """Return a number of two bytes."""
        return self._number(_uint16)

    def uint32(self) -> int:
        """Return a number of four bytes."""
        return self._number(_uint32)

    def uint64(self) -> int:
        """Return a number of eight bytes."""
        return self._number(_uint64)

    def text(self) -> str:
        """Return a text."""
        data = self.take(self.uint32())
        try:
            return data.decode()
        except UnicodeDecodeError:
            raise self.wrong("a text is not UTF-8") from None

    def texts(self) -> dict[str, str]:
        """Return a map of texts."""
        end = self.uint32() + self.at
        found: dict[str, str] = {}
        while self.at < end:
            name = self.text()
            found[name] = self.text()
        if self.at != end:
            raise self.wrong("a map exceeds its stated length")
        return found


def schema_of(body: Body) -> tuple[int, McapSchema]:
    """Return the number and content of a record SCHEMA."""
    number, name, encoding = body.uint16(), body.text(), body.text()
    return number, McapSchema(name, encoding, body.take(body.uint32()))


def channel_of(body: Body, schemas: Mapping[int, McapSchema]) -> RecordedChannel:
    """Return a record CHANNEL.

    Args:
        body: of the record.
        schemas: those before it, by number.

    Raises:
        ROSBagFormatException: it is none, or its schema is not there.
    """
    number, schema_id, topic, encoding = body.uint16(), body.uint16(), body.text(), body.text()
    metadata = body.texts()
    if schema_id and schema_id not in schemas:
        raise body.wrong(f"the channel {topic} has the schema {schema_id}, which is not there,")
    schema = schemas[schema_id] if schema_id else NO_SCHEMA
    channel = RecordedChannel(number, topic, encoding, schema, metadata)
    if encoding == ROS1 and schema.encoding == ROS1_SCHEMA:
        channel.connection = Connection(number, topic, _header_of(channel))
    return channel


def _header_of(channel: RecordedChannel) -> dict[str, bytes | str]:
    """Return the connection header in a channel. Fields are in rosbag's order."""
    about: dict[str, bytes | str] = {**channel.metadata, "topic": channel.metadata.get("topic", channel.topic)}
    about |= {"type": channel.schema.name, "message_definition": channel.schema.data}
    if "latching" in channel.metadata:
        about["latching"] = _LATCHING_BACK.get(channel.metadata["latching"], channel.metadata["latching"])
    if "md5sum" not in about:
        about["md5sum"] = md5sum_of(channel.schema.name, channel.schema.data.decode(errors="replace"))
    return {name: about[name] for name in sorted(about)}


def channel_of_connection(connection: Connection) -> RecordedChannel:
    """Return the channel of a bag's connection. Header fields other than type and definition are in its metadata."""
    header = {
        name: value if isinstance(value, str) else value.decode(errors="replace")
        for name, value in connection.header.items()
        if name not in ("type", "message_definition")
    }
    if "latching" in header:
        header["latching"] = _LATCHING.get(header["latching"], header["latching"])
    definition = connection.header["message_definition"]
    data = definition.encode() if isinstance(definition, str) else bytes(definition)
    schema = McapSchema(connection.datatype, ROS1_SCHEMA, data)
    return RecordedChannel(connection.id, connection.topic, ROS1, schema, header, connection)


def chunk_of(body: Body) -> ChunkRecord:
    """Return the head of a record CHUNK.

    Raises:
        ROSBagFormatException: it is none, or compressed in a way that is not known.
    """
    start, end, size, crc = body.uint64(), body.uint64(), body.uint64(), body.uint32()
    kind = body.text()
    if kind not in _KINDS:
        raise body.wrong(f"a chunk is compressed by {kind[:20]!r}, which is not known,")
    stored = body.uint64()
    return ChunkRecord(start, end, size, crc, _KINDS[kind], body.at, stored)


def unpacked(chunk: ChunkRecord, stored: bytes, place: int) -> bytes:
    """Return the records of a chunk.

    Raises:
        ROSBagFormatException: they are damaged.
    """
    if chunk.size > compression.LARGEST:
        raise ROSBagFormatException(f"a chunk of {chunk.size:,} bytes is too large, at byte {place:,}")
    try:
        data = compression.decompress(chunk.kind, stored)
    except ROSBagFormatException as error:
        raise ROSBagFormatException(f"{error}, at byte {place:,}") from None
    if len(data) != chunk.size:
        raise ROSBagFormatException(f"a chunk has {len(data):,} bytes, not {chunk.size:,}, at byte {place:,}")
    if chunk.crc and zlib.crc32(data) != chunk.crc:
        raise ROSBagFormatException(f"the stated checksum of a chunk does not match, at byte {place:,}")
    return data


def statistics_of(body: Body) -> dict[int, int]:
    """Return the number of messages of each channel from a record STATISTICS."""
    body.take(8 + 2 + 4 + 4 + 4 + 4 + 8 + 8)
    return {body.uint16(): body.uint64() for _ in range(body.uint32() // 10)}
