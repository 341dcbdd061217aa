"""The content of a bag according to its index: connections, chunks, and positions of messages.

Imports records and errors.
"""

from __future__ import annotations

import heapq
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
    """The index of a bag: connections by number, chunks in the order of the file, entries by connection and time."""

    connections: dict[int, Connection] = field(default_factory=dict)
    chunks: list[Chunk] = field(default_factory=list)
    indexes: dict[int, list[Entry]] = field(default_factory=dict)

    def entries(self, connections: Iterable[Connection]) -> Iterator[Entry]:
        """Return the entries of some connections, by time."""
        return heapq.merge(*(self.indexes.get(each.id, []) for each in connections), key=attrgetter("time"))

    def double(self) -> None:
        """List each entry twice, as ROS does when it reads the entries that it knows from the file."""
        for index in self.indexes.values():
            index += index[:]

    def settle(self) -> None:
        """All entries were read: put them in order, and forget connections that have no message."""
        for number, index in list(self.indexes.items()):
            index.sort(key=attrgetter("time"))
            if not index:
                del self.indexes[number]
                self.connections.pop(number, None)
