"""Reading a bag that has no index, chunk by chunk, as far as it is sound. Imports records, index and contents."""

from __future__ import annotations

from collections.abc import Generator
from io import BytesIO
from typing import BinaryIO

from . import compression, index, records
from .contents import Chunk, Connection, Contents, Entry
from .errors import ROSBagException


def scan(file: BinaryIO, contents: Contents, start: int) -> Generator[int, None, int]:
    """Fill in the contents of a bag.

    Args:
        file: the bag.
        contents: gets the results.
        start: where its chunks begin.

    Yields:
        The position of each chunk.

    Returns:
        The end of the last valid chunk with its index.
    """
    end = file.seek(0, 2)
    at = sound = start
    try:
        file.seek(start)
        _skip_index(file, end)  # records that a later version may have put before the first chunk
        while (at := file.tell()) < end:
            sound = at
            yield at
            file.seek(at)
            _read_chunk(file, contents, at, end)
        sound = at
    except (ROSBagException, OSError, EOFError, ValueError):
        pass  # the rest is invalid, and is left out
    contents.sort()
    contents.forget_empty()
    return sound


def _read_chunk(file: BinaryIO, contents: Contents, at: int, end: int) -> None:
    chunk = Chunk(at, 0, 0)
    index.read_chunk_header(file, chunk)
    after = chunk.data_pos + chunk.stored_size
    if after > end:
        raise ROSBagException(f"unterminated chunk at {at}")
    data = compression.decompress(chunk.compression, records.read(file, chunk.stored_size))
    connections, entries = _messages(data, at, contents)
    for number, entry in entries:
        if not chunk.connection_counts:
            chunk.start = chunk.end = entry.time
        chunk.add(number, entry.time)
    indexed = _skip_index(file, end)
    for connection in connections:
        contents.connections.setdefault(connection.id, connection)
    for number, entry in entries:
        contents.indexes.setdefault(number, []).append(entry)
    if indexed is not None and indexed != len(entries):  # as in ROS, the messages remain, and cannot be read
        raise ROSBagException(f"index shorter than expected ({indexed} vs {len(entries)})")
    contents.chunks.append(chunk)


def _messages(data: bytes, at: int, contents: Contents) -> tuple[list[Connection], list[tuple[int, Entry]]]:
    """Return the connections in a chunk, and its messages with the numbers of their connections."""
    connections: list[Connection] = []
    entries: list[tuple[int, Entry]] = []
    known = set(contents.connections)
    file = BytesIO(data)
    while (offset := file.tell()) < len(data):
        op = records.peek_op(file)
        if op == records.OP_CONNECTION:
            connections.append(index.read_connection(file))
            known.add(connections[-1].id)
        elif op == records.OP_MSG_DATA:
            fields = records.read_header(file)
            records.skip_sized(file)
            number = records.uint32_field(fields, "conn")
            if number not in known:
                raise ROSBagException(
                    f"connection id (id={number}) in chunk at position {at} not preceded by connection record"
                )
            entries.append((number, Entry(records.time_field(fields, "time"), at, offset)))
        else:
            records.skip_record(file)
    return connections, entries


def _skip_index(file: BinaryIO, end: int) -> int | None:
    """Skip the index of a chunk. Returns how many messages it has, or None if another chunk follows."""
    total = 0
    while file.tell() < end:
        op = records.peek_op(file)
        if op == records.OP_CHUNK:
            return None
        if op == records.OP_INDEX_DATA:
            total += len(index.read_chunk_entries(file, 0)[1])
        else:
            records.skip_record(file)
            if file.tell() > end:
                raise ROSBagException("a record ends behind the file")
    return total
