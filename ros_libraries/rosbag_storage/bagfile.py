"""`BagFile`: one bag that is read or written, or both in turn. Imports the rest of the package."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator, Mapping
from io import BytesIO, UnsupportedOperation
from typing import BinaryIO, NamedTuple

from . import compression, index, records, scan
from .contents import Chunk, Connection, Contents, Entry
from .errors import ROSBagEncryptNotSupportedException, ROSBagException, ROSBagFormatException, ROSBagUnindexedException

_OVERWRITTEN = (
    "cfepy: the bag was read after the last write, so that its index overwrites a part of it and the bag is unindexed,"
    " as in ROS; write a message before closing it, or read it when it is closed"
)


class Message(NamedTuple):
    """A message as stored in a bag; its time is in ns."""

    connection: Connection
    time: int
    data: bytes


class BagFile:
    """A bag.

    Args:
        file: opened for reading, or for both if the bag is written; call `create` or `open` next.

    Attributes:
        contents: the index.
        version: such as 200 for 2.0.
        header_pos: position of the header's record.
    """

    def __init__(self, file: BinaryIO) -> None:
        self.file = file
        self.contents = Contents()
        self.version = 200
        self.header_pos = 0
        self._cached: tuple[int, bytes] = (-1, b"")
        self._read_end = 0  # where the last reading ended in the file; 0 if something was written since
        self._open: OpenChunk | None = None

    # -- reading -----------------------------------------------------------------------------------------------------

    def read_version(self) -> None:
        """Read the first line.

        Raises:
            ROSBagException: it is not a bag, or its version is not supported.
        """
        line = self.file.readline().rstrip()
        if not line:
            raise ROSBagException("empty file")
        match = re.match(rb"#ROS.* V(\d).(\d)", line)
        if match is None:
            raise ROSBagException("This does not appear to be a bag file")
        self.version = int(match[1]) * 100 + int(match[2])
        self.header_pos = self.file.tell()
        if self.version // 100 == 1:
            raise ROSBagException(f"unsupported bag version {self.version}. Please convert bag to newer format.")
        if self.version // 100 != 2:
            raise ROSBagException(f"unknown bag version {self.version}")

    def open(self, with_entries: bool = True) -> None:
        """Read the index.

        Args:
            with_entries: also read the position of each message; otherwise they are read when they are first needed.

        Raises:
            ROSBagUnindexedException: the index is missing, or it cannot be read.
            ROSBagEncryptNotSupportedException: the bag is encrypted.
        """
        try:
            header = self._file_header()
            self.contents = index.read_index(self.file, header)
            if with_entries:
                self.read_entries()
        except (ROSBagEncryptNotSupportedException, ROSBagUnindexedException):
            raise
        except (ROSBagException, UnicodeDecodeError, OSError):
            raise ROSBagUnindexedException from None

    def read_entries(self) -> None:
        """Read where each message is, when `open` left it out."""
        index.read_entries(self.file, self.contents)

    def _file_header(self) -> dict[str, bytes]:
        self.file.seek(self.header_pos)
        header = records.read_header(self.file, records.OP_FILE_HEADER)
        records.skip_sized(self.file)
        if header.get("encryptor"):
            name = records.text(header["encryptor"])
            raise ROSBagEncryptNotSupportedException(f"the bag is encrypted by {name}, which is not supported")
        return header

    def reindex(self) -> Iterator[int]:
        """Rebuild the index from the chunks. Yields the position of each, and drops the bytes after the last valid one.

        Raises:
            ROSBagException: the file has no valid header.
            UnsupportedOperation: the file cannot be written, and has no index, or has bytes after the last valid
                chunk; as in ROS the last chunk is then missing.
        """
        is_indexed = records.uint64_field(self._file_header(), "index_pos") > 0
        self._file_header()
        self.contents = Contents()
        start = self.file.tell()
        end = yield from scan.scan(self.file, self.contents, start)
        if not is_indexed and not self.file.writable():
            del self.contents.chunks[-1:]
            raise UnsupportedOperation("truncate")
        if start < end < self.file.seek(0, 2):
            self.file.truncate(end)

    def read(self, entry: Entry | tuple[int, int]) -> Message:
        """Return the message at an entry, or at a (chunk position, offset).

        Raises:
            ROSBagException: there is no message.
        """
        chunk_pos, offset = entry[-2:]
        data = BytesIO(self._chunk_data(chunk_pos))
        data.seek(offset)
        fields = records.read_header(data)
        while (op := records.uint8_field(fields, "op")) == records.OP_CONNECTION:
            records.skip_sized(data)
            fields = records.read_header(data)
        if op != records.OP_MSG_DATA:
            raise ROSBagFormatException(f"Expecting OP_MSG_DATA, got {op}")
        connection = self.contents.connections[records.uint32_field(fields, "conn")]
        return Message(connection, records.time_field(fields, "time"), records.read_record_data(data))

    def _chunk_data(self, pos: int) -> bytes:
        if self._cached[0] != pos:
            chunk = next((each for each in self.contents.chunks if each.pos == pos), None)
            if chunk is None:
                raise ROSBagException(f"no chunk at position {pos}")
            self.file.seek(chunk.data_pos)
            stored = records.read(self.file, chunk.stored_size)
            self._cached = (pos, compression.decompress(chunk.compression, stored))
            self._read_end = self.file.tell()
        return self._cached[1]

    # -- writing -----------------------------------------------------------------------------------------------------

    def create(self) -> None:
        """Begin a new bag."""
        self.file.write(records.VERSION)
        self.header_pos = self.file.tell()
        self._write_file_header(0)

    def append(self) -> None:
        """Continue a bag that was opened. Its index is removed, until `finish` writes the new one."""
        end = index.position(self._file_header())
        self.file.truncate(end)
        self._write_file_header(0, counts=False)
        self.file.seek(0, 2)

    def _write_file_header(self, index_pos: int, counts: bool = True) -> None:
        self.file.seek(self.header_pos)
        fields = {
            "op": records.pack_uint8(records.OP_FILE_HEADER),
            "index_pos": records.pack_uint64(index_pos),
            "conn_count": records.pack_uint32(len(self.contents.connections) if counts else 0),
            "chunk_count": records.pack_uint32(len(self.contents.chunks) if counts else 0),
        }
        records.write_record(self.file, fields, padded_size=records.FILE_HEADER_LENGTH)

    def connect(self, topic: str, header: Mapping[str, bytes | str], kind: str = compression.NONE) -> Connection:
        """Return a new connection, whose messages can be written from now on. `kind` compresses the chunk it begins in.

        Raises:
            ROSBagFormatException: the header lacks a field that a reader needs.
        """
        number = max(self.contents.connections, default=-1) + 1
        connection = Connection(number, topic, header)
        self._chunk(kind).write_connection(connection)
        self.contents.connections[number] = connection
        return connection

    def write(self, connection: Connection, time: int, data: bytes, kind: str = compression.NONE) -> int:
        """Write a message.

        Args:
            connection: its connection; see `connect`.
            time: in ns.
            data: the serialised message.
            kind: compresses the chunk, if the message begins one.

        Returns:
            The bytes of the chunk so far; `flush` ends it when there are enough.
        """
        self._read_end = 0
        chunk = self._chunk(kind)
        self.contents.insert(connection.id, chunk.enter(connection, time))
        return chunk.write_message(connection, time, data)

    def enter(self, connection: Connection, time: int, kind: str = compression.NONE) -> None:
        """Add an entry to the index alone, for a message that could not be serialized. The arguments are the same as
        for `write`.
        """
        self._read_end = 0
        self.contents.insert(connection.id, self._chunk(kind).enter(connection, time))

    def _chunk(self, kind: str) -> OpenChunk:
        if self._open is None:
            self._open = OpenChunk(kind, self.file.seek(0, 2))
        return self._open

    @property
    def pending(self) -> int:
        """Bytes that ROS has in the file already for the open chunk; compressors hold its data back."""
        if self._open is None:
            return 0
        header = len(self._open.header(0, 0))
        return header + (self._open.data.tell() if self._open.kind == compression.NONE else 0)

    def all_chunks(self) -> list[Chunk]:
        """Return the chunks in the file. If there are none yet, return the one that is being written, as ROS does."""
        made = None if self._open is None else self._open.chunk
        return self.contents.chunks if made is None or self.contents.chunks else [made]

    def flush(self) -> None:
        """End the chunk, if there is one, and write it to the file."""
        made, self._open = self._open, None
        if made is None or made.chunk is None:
            return
        pos = self.file.seek(0, 2)
        if pos != made.chunk.pos:  # a program has written to the file itself
            self.contents.move(made.chunk.pos, pos)
            made.chunk.pos = pos
        made.write_to(self.file)
        self.contents.chunks.append(made.chunk)
        for number, found in made.entries.items():
            index.write_entries(self.file, number, found)
        self.file.flush()

    def finish(self) -> None:
        """Write the index and its position, which completes the bag.

        As in ROS, the index begins where the last reading ended, if there was one after the last writing.
        """
        self.flush()
        end = self.file.seek(self._read_end) if self._read_end else self.file.seek(0, 2)
        if end < self.file.seek(0, 2):
            print(_OVERWRITTEN, file=sys.stderr)
        self.file.seek(end)
        index.write_index(self.file, self.contents)
        self._write_file_header(end)
        self.file.flush()


class OpenChunk:
    """A chunk that is being written. It is added to the file as a whole.

    Args:
        kind: kind of its compression.
        pos: its position in the file.
    """

    def __init__(self, kind: str, pos: int) -> None:
        self.kind = kind
        self.pos = pos
        self.data = BytesIO()
        self.chunk: Chunk | None = None  # None as long as there is no message
        self.entries: dict[int, list[tuple[int, int]]] = {}

    def write_connection(self, connection: Connection) -> None:
        """Tell of a connection."""
        index.write_connection(self.data, connection)

    def write_message(self, connection: Connection, time: int, data: bytes) -> int:
        """Write a message that was entered. Returns the size of the chunk."""
        fields = {
            "op": records.pack_uint8(records.OP_MSG_DATA),
            "conn": records.pack_uint32(connection.id),
            "time": records.pack_time(time),
        }
        records.write_record(self.data, fields, data)
        return self.data.tell()

    def enter(self, connection: Connection, time: int) -> Entry:
        """Add an entry that leads to the next record. Returns it."""
        if self.chunk is None:
            self.chunk = Chunk(self.pos, time, time)
        self.chunk.add(connection.id, time)
        found = self.entries.setdefault(connection.id, [])
        offset = self.data.tell()
        found.append((time, offset))
        if len(found) > 1 and found[-2][0] > time:
            found.sort(key=lambda each: each[0])
        return Entry(time, self.pos, offset)

    def header(self, size: int, stored_size: int) -> bytes:
        """Return the chunk's record up to its data.

        Args:
            size: bytes of the data.
            stored_size: the same after compression.
        """
        fields: records.Fields = {
            "op": records.pack_uint8(records.OP_CHUNK),
            "compression": self.kind,
            "size": records.pack_uint32(size),
        }
        made = BytesIO()
        records.write_header(made, fields)
        return made.getvalue() + records.pack_uint32(stored_size)

    def write_to(self, file: BinaryIO) -> None:
        """Write the chunk's record."""
        assert self.chunk is not None
        chunk, data = self.chunk, self.data.getvalue()
        stored = compression.compress(self.kind, data)
        file.write(self.header(len(data), len(stored)))
        chunk.compression, chunk.size, chunk.stored_size, chunk.data_pos = (
            self.kind,
            len(data),
            len(stored),
            file.tell(),
        )
        file.write(stored)
