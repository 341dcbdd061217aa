"""The index of a bag, read and written: the records behind each chunk, and those at the end of the file.

Imports records, contents and errors.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import BinaryIO

from . import records
from .contents import Chunk, Connection, Contents, Entry
from .errors import ROSBagFormatException, ROSBagUnindexedException

# -- reading -----------------------------------------------------------------------------------------------------------


def position(header: Mapping[str, bytes]) -> int:
    """Return the position of the index from the header of the file.

    Raises:
        ROSBagUnindexedException: there is no index.
    """
    found = records.uint64_field(header, "index_pos")
    if found == 0:
        raise ROSBagUnindexedException
    return found


def read_index(file: BinaryIO, header: Mapping[str, bytes]) -> Contents:
    """Return connections and chunks from the end of the file.

    Args:
        file: the bag.
        header: header of the file.

    Raises:
        ROSBagException: the index is missing or broken.
    """
    file.seek(position(header))
    contents = Contents()
    for _ in range(records.uint32_field(header, "conn_count")):
        connection = read_connection(file)
        contents.connections[connection.id] = connection
        contents.indexes[connection.id] = []
    contents.chunks = [_read_chunk_info(file) for _ in range(records.uint32_field(header, "chunk_count"))]
    for chunk in contents.chunks:
        file.seek(chunk.pos)
        read_chunk_header(file, chunk)
    return contents


def read_entries(file: BinaryIO, contents: Contents) -> None:
    """Add where each message is, from behind the chunks, in the order of these."""
    for chunk in contents.chunks:
        file.seek(chunk.data_pos + chunk.stored_size)
        for _ in chunk.connection_counts:
            number, entries = read_chunk_entries(file, chunk.pos)
            contents.indexes[number].extend(entries)
    contents.forget_empty()


def read_connection(file: BinaryIO) -> Connection:
    """Return a connection's record."""
    fields = records.read_header(file, records.OP_CONNECTION)
    header = records.read_header(file)
    return Connection(records.uint32_field(fields, "conn"), records.text_field(fields, "topic"), header)


def _read_chunk_info(file: BinaryIO) -> Chunk:
    fields = records.read_header(file, records.OP_CHUNK_INFO)
    version = records.uint32_field(fields, "ver")
    if version != records.CHUNK_INDEX_VERSION:
        raise ROSBagFormatException(f"Unknown chunk info record version: {version}")
    start, end = records.time_field(fields, "start_time"), records.time_field(fields, "end_time")
    chunk = Chunk(records.uint64_field(fields, "chunk_pos"), start, end)
    records.read_uint32(file)
    for _ in range(records.uint32_field(fields, "count")):
        number, count = records.pair.unpack(records.read(file, records.pair.size))
        chunk.connection_counts[number] = count
    return chunk


def read_chunk_header(file: BinaryIO, chunk: Chunk) -> None:
    """Read the compression and sizes of a chunk. The file then stands at the data."""
    fields = records.read_header(file, records.OP_CHUNK)
    chunk.compression = records.text_field(fields, "compression")
    chunk.size = records.uint32_field(fields, "size")
    chunk.stored_size = records.read_uint32(file)
    chunk.data_pos = file.tell()


def read_chunk_entries(file: BinaryIO, chunk_pos: int) -> tuple[int, list[Entry]]:
    """Return the number of a connection, and where its messages are in a chunk.

    The length of the data is not looked at: ROS's first writers got it wrong.
    """
    fields = records.read_header(file, records.OP_INDEX_DATA)
    version = records.uint32_field(fields, "ver")
    if version != records.INDEX_VERSION:
        raise ROSBagFormatException(f"expecting index version {records.INDEX_VERSION}, got {version}")
    records.read_uint32(file)
    count = records.uint32_field(fields, "count")
    data = records.read(file, count * records.index_entry.size)
    entries = [
        Entry(seconds * records.NS_PER_S + nanoseconds, chunk_pos, offset)
        for seconds, nanoseconds, offset in records.index_entry.iter_unpack(data)
    ]
    return records.uint32_field(fields, "conn"), entries


# -- writing -----------------------------------------------------------------------------------------------------------


def write_connection(file: BinaryIO, connection: Connection) -> None:
    """A connection's record."""
    fields: records.Fields = {
        "op": records.pack_uint8(records.OP_CONNECTION),
        "topic": connection.topic,
        "conn": records.pack_uint32(connection.id),
    }
    records.write_header(file, fields)
    records.write_header(file, connection.header)


def write_entries(file: BinaryIO, connection: int, entries: list[tuple[int, int]]) -> None:
    """Write the positions of a connection's messages in the chunk before: time in ns and offset of each."""
    fields = {
        "op": records.pack_uint8(records.OP_INDEX_DATA),
        "conn": records.pack_uint32(connection),
        "ver": records.pack_uint32(records.INDEX_VERSION),
        "count": records.pack_uint32(len(entries)),
    }
    pack = records.index_entry.pack
    data = b"".join(pack(time // records.NS_PER_S, time % records.NS_PER_S, offset) for time, offset in entries)
    records.write_record(file, fields, data)


def write_index(file: BinaryIO, contents: Contents) -> None:
    """Connections and chunks, at the end of the file."""
    for connection in contents.connections.values():
        write_connection(file, connection)
    for chunk in contents.chunks:
        fields = {
            "op": records.pack_uint8(records.OP_CHUNK_INFO),
            "ver": records.pack_uint32(records.CHUNK_INDEX_VERSION),
            "chunk_pos": records.pack_uint64(chunk.pos),
            "start_time": records.pack_time(chunk.start),
            "end_time": records.pack_time(chunk.end),
            "count": records.pack_uint32(len(chunk.connection_counts)),
        }
        data = b"".join(records.pair.pack(*each) for each in chunk.connection_counts.items())
        records.write_record(file, fields, data)
