"""`McapFile`: an MCAP file whose topics of ROS 1 are read as those of a bag. Imports what the package has."""

from __future__ import annotations

from collections.abc import Iterator
from typing import BinaryIO, NoReturn

from . import mcap_records as mcap
from . import records
from .bagfile import BagFile, Message
from .contents import Chunk, Connection, Entry
from .errors import ROSBagException, ROSBagFormatException

_SCHEMAS_AND_CHANNELS = (mcap.SCHEMA, mcap.CHANNEL)


class McapFile(BagFile):
    """An MCAP file, read as a bag.

    The file is read once from its beginning; its own index is not needed. Channels other than ROS 1 topics are in
    `channels` only.

    Args:
        file: opened for reading.

    Attributes:
        channels: all channels by number.
    """

    def __init__(self, file: BinaryIO) -> None:
        super().__init__(file)
        self.channels: dict[int, mcap.RecordedChannel] = {}
        self._schemas: dict[int, mcap.McapSchema] = {}
        self._chunks: dict[int, mcap.ChunkRecord] = {}

    def read_version(self) -> None:
        if records.read(self.file, len(mcap.MAGIC)) != mcap.MAGIC:
            raise ROSBagException("This does not appear to be an MCAP file")
        self.header_pos = self.file.tell()

    def open(self, with_entries: bool = True) -> None:
        """Go through the file.

        Raises:
            ROSBagFormatException: it is damaged, or was not finished.
        """
        end = self.file.seek(0, 2)
        at = self.header_pos
        ended = False
        while not ended:
            op, size = self._prefix(at, end)
            self._record(op, at, size)
            at += mcap.PREFIX.size + size
            ended = op == mcap.FOOTER
        self.file.seek(at)
        if records.read(self.file, min(end - at, len(mcap.MAGIC))) != mcap.MAGIC:
            raise ROSBagFormatException(f"the recording was not finished: it has no end at byte {at:,}")
        self.contents.sort()
        self.contents.forget_empty()

    def read_entries(self) -> None:
        """`open` has read them."""

    def _prefix(self, at: int, end: int) -> tuple[int, int]:
        if end - at < mcap.PREFIX.size:
            raise ROSBagFormatException(f"the recording was not finished: it ends at byte {end:,}")
        self.file.seek(at)
        op, size = mcap.PREFIX.unpack(records.read(self.file, mcap.PREFIX.size))
        if op == 0 or size > end - at - mcap.PREFIX.size:
            raise ROSBagFormatException(f"a record of {size:,} bytes does not fit into the file, at byte {at:,}")
        return int(op), int(size)

    def _record(self, op: int, at: int, size: int) -> None:
        place = at + mcap.PREFIX.size
        if op in _SCHEMAS_AND_CHANNELS:
            self._define(op, mcap.Body(records.read(self.file, size), place))
        elif op == mcap.CHUNK:
            chunk = self._chunk_head(at, size)
            self._chunks[at] = chunk
            self._index(at, chunk, self._chunk_data(at), place)
        elif op == mcap.MESSAGE:
            head = records.read(self.file, min(size, mcap.MESSAGE_HEAD.size))
            self._chunks[at] = mcap.ChunkRecord(0, 0, mcap.PREFIX.size + size, 0, "none", 0, 0)
            data = mcap.PREFIX.pack(op, size) + head
            self._index(at, self._chunks[at], data, at)

    def _chunk_head(self, at: int, size: int) -> mcap.ChunkRecord:
        place = at + mcap.PREFIX.size
        body = mcap.Body(records.read(self.file, min(size, 64)), place)
        chunk = mcap.chunk_of(body)
        if chunk.data_at + chunk.stored_size > size:
            raise body.wrong(f"a chunk has {chunk.stored_size:,} bytes, more than its record,")
        return chunk._replace(data_at=place + chunk.data_at)

    def _define(self, op: int, body: mcap.Body) -> None:
        if op == mcap.SCHEMA:
            number, schema = mcap.schema_of(body)
            self._schemas[number] = schema
            return
        channel = mcap.channel_of(body, self._schemas)
        if channel.id in self.channels:
            return
        self.channels[channel.id] = channel
        if channel.connection is not None:
            self.contents.connections[channel.id] = channel.connection
            self.contents.indexes[channel.id] = []

    def _index(self, at: int, record: mcap.ChunkRecord, data: bytes, place: int) -> None:
        """Add the contents of a chunk, or the message that stands in its place."""
        chunk = Chunk(at, 0, 0, compression=record.kind, size=record.size, stored_size=record.stored_size)
        for op, offset, body in _within(data, place):
            if op in _SCHEMAS_AND_CHANNELS:
                self._define(op, body)
            elif op == mcap.MESSAGE:
                number, _, time, _ = mcap.MESSAGE_HEAD.unpack(body.take(mcap.MESSAGE_HEAD.size))
                if number not in self.channels:
                    raise body.wrong(f"a message has the channel {number}, which is not there,")
                if number in self.contents.connections:
                    if not chunk.connection_counts:
                        chunk.start = chunk.end = time
                    chunk.add(number, time)
                    self.contents.indexes[number].append(Entry(time, at, offset))
        if chunk.connection_counts:
            self.contents.chunks.append(chunk)

    def _chunk_data(self, pos: int) -> bytes:
        if self._cached[0] != pos:
            if pos not in self._chunks:
                raise ROSBagException(f"no chunk at position {pos}")
            chunk = self._chunks[pos]
            self.file.seek(chunk.data_at or pos)
            if chunk.data_at:
                stored = records.read(self.file, chunk.stored_size)
                self._cached = (pos, mcap.unpacked(chunk, stored, chunk.data_at))
            else:
                self._cached = (pos, records.read(self.file, chunk.size))
        return self._cached[1]

    def read(self, entry: Entry | tuple[int, int]) -> Message:
        chunk_pos, offset = entry[-2:]
        data = self._chunk_data(chunk_pos)
        _, size = mcap.PREFIX.unpack_from(data, offset)
        start = offset + mcap.PREFIX.size
        number, _, time, _ = mcap.MESSAGE_HEAD.unpack_from(data, start)
        content = data[start + mcap.MESSAGE_HEAD.size : start + size]
        return Message(self.contents.connections[number], time, content)

    # -- operations that an MCAP file does not support ---------------------------------------------------------------

    def reindex(self) -> Iterator[int]:
        """Refuse: an MCAP file needs no index, see `cfepy rosbag recover`."""
        _only_read()

    def create(self) -> None:
        """MCAP files are written by `cfepy`."""
        _only_read()

    def append(self) -> None:
        """MCAP files are written by `cfepy`."""
        _only_read()

    def connect(self, *args: object, **more: object) -> Connection:
        """MCAP files are written by `cfepy`."""
        _only_read()

    def finish(self) -> None:
        """Nothing is to be written."""


def _within(data: bytes, place: int) -> Iterator[tuple[int, int, mcap.Body]]:
    """Yield (opcode, offset, body) of the records of a chunk.

    The body of a message outside of a chunk may be its head only.
    """
    at = 0
    while at < len(data):
        if len(data) - at < mcap.PREFIX.size:
            raise ROSBagFormatException(f"a chunk ends in the middle of a record, at byte {place:,}")
        op, size = mcap.PREFIX.unpack_from(data, at)
        start = at + mcap.PREFIX.size
        yield op, at, mcap.Body(memoryview(data)[start : start + size], place + start)
        at = start + size


def _only_read() -> NoReturn:
    raise ROSBagException("MCAP files are only read here; cfepy rosbag convert writes them")


def opened(file: BinaryIO) -> BagFile:
    """Return the reader of a file: an MCAP file if it begins as one, otherwise a bag.

    Args:
        file: opened for reading; it stands at its beginning, and does so afterwards.
    """
    begin = file.tell()
    is_mcap = file.read(len(mcap.MAGIC)) == mcap.MAGIC
    file.seek(begin)
    return McapFile(file) if is_mcap else BagFile(file)
