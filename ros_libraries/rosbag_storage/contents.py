"""The content of a bag according to its index: connections, chunks, and positions of messages.

Imports records and errors.
"""

from __future__ import annotations

import heapq
from bisect import insort
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from operator import attrgetter
from typing import NamedTuple

from . import records
from .errors import ROSBagFormatException


class Entry(NamedTuple):
    """Where a message is: its time in ns, the position of its chunk in the file, its own in the chunk."""

    time: int
    chunk_pos: int
    offset: int


class Connection:
    """One publisher of a topic, as described by its connection header.

    Args:
        id: number in the bag.
        topic: name.
        header: the connection header; written unchanged.

    Raises:
        ROSBagFormatException: the header lacks a field that a reader needs.
    """

    def __init__(self, id: int, topic: str, header: Mapping[str, bytes | str]) -> None:
        self.id = id
        self.topic = topic
        self.header = header
        try:
            self.datatype = records.text(header["type"])
            self.md5sum = records.text(header["md5sum"])
            self.msg_def = records.text(header["message_definition"])
        except KeyError as error:
            raise ROSBagFormatException(f"connection header field {error} not found") from None

    def __str__(self) -> str:
        return f"{self.id} on {self.topic}: {dict(self.header)}"


@dataclass
class Chunk:
    """A chunk: position in the file, first and last time in ns, messages per connection, compression and size."""

    pos: int
    start: int
    end: int
    connection_counts: dict[int, int] = field(default_factory=dict)
    compression: str = ""
    size: int = 0
    stored_size: int = 0
    data_pos: int = 0

    def add(self, connection: int, time: int) -> None:
        """Count a message."""
        self.start = min(self.start, time)
        self.end = max(self.end, time)
        self.connection_counts[connection] = self.connection_counts.get(connection, 0) + 1


@dataclass
class Contents:
    """The index of a bag: connections by number, chunks in the order of the file, entries by connection.

    As in ROS, the entries of a connection are ordered by time in a bag that was written or scanned. In one that was
    opened they are in the order of the chunks, whose times may overlap.
    """

    connections: dict[int, Connection] = field(default_factory=dict)
    chunks: list[Chunk] = field(default_factory=list)
    indexes: dict[int, list[Entry]] = field(default_factory=dict)

    def entries(self, connections: Iterable[Connection], reverse: bool = False) -> Iterator[Entry]:
        """Return the entries of some connections: the earliest (or latest) of their next ones, again and again."""
        indexes = (self.indexes.get(each.id, []) for each in connections)
        ordered = (reversed(index) for index in indexes) if reverse else indexes
        return heapq.merge(*ordered, key=attrgetter("time"), reverse=reverse)

    def insert(self, connection: int, entry: Entry) -> None:
        """Add the entry of a new message. If the entries before are not in order, neither is its place, as in ROS."""
        insort(self.indexes.setdefault(connection, []), entry, key=attrgetter("time"))

    def move(self, before: int, after: int) -> None:
        """Give the entries of a chunk its new position in the file."""
        for index in self.indexes.values():
            index[:] = [each._replace(chunk_pos=after) if each.chunk_pos == before else each for each in index]

    def sort(self) -> None:
        """Order the entries of each connection by time."""
        for index in self.indexes.values():
            index.sort(key=attrgetter("time"))

    def forget_empty(self) -> None:
        """Forget connections that have no message, when all entries were read."""
        for number, index in list(self.indexes.items()):
            if not index:
                del self.indexes[number]
                self.connections.pop(number, None)
