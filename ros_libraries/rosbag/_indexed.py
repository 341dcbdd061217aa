"""The index of a bag for tools around rosbag, with rosbag's names. Imports rosbag_storage."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterable, Iterator
from operator import attrgetter
from typing import Any

from rosbag_storage import BagFile, Chunk, Connection, Contents, Entry

from . import _search, _views
from ._search import Filter

_TIME = attrgetter("time")


class Indexed:
    """The index of a `Bag`.

    `_connection_indexes_read` is true if the positions of messages have been read from the file. As in ROS, a bag that
    is written or was indexed anew knows them already, and then has each of them twice.
    """

    __storage__: BagFile
    _connection_indexes_read: bool

    def __contents__(self) -> Contents:
        """Return the contents, with the entries."""
        if not self._connection_indexes_read:
            self.__storage__.read_entries()
            self._connection_indexes_read = True
        return self.__storage__.contents

    def __all_chunks__(self) -> list[Chunk]:
        """Return the chunks; see `BagFile.all_chunks`."""
        return self.__storage__.all_chunks()

    @property
    def _connections(self) -> dict[int, Connection]:
        return self.__storage__.contents.connections

    @property
    def _chunks(self) -> list[_views.ChunkInfo]:
        return [_views.chunk_view(chunk) for chunk in self.__storage__.contents.chunks]

    @property
    def _connection_indexes(self) -> dict[int, list[_views.IndexEntry]]:
        return {key: [_views.entry_view(each) for each in index] for key, index in self.__contents__().indexes.items()}

    @property
    def _file_header_pos(self) -> int:
        return self.__storage__.header_pos

    @property
    def _uncompressed_size(self) -> int:
        chunks = self.__storage__.contents.chunks
        return sum(chunk.size for chunk in chunks) if chunks else self.__size__()

    @property
    def _has_compressed_chunks(self) -> bool:
        return any(chunk.compression != "none" for chunk in self.__storage__.contents.chunks)

    def __size__(self) -> int:
        """Return the bytes of the file, including the chunk that is being written."""
        file = self.__storage__.file
        at = file.tell()
        size = int(file.seek(0, 2))
        file.seek(at)
        return size + self.__storage__.pending

    @property
    def _version(self) -> int:
        return self.__storage__.version

    def _get_connections(
        self, topics: str | Iterable[str] | None = None, connection_filter: Filter | None = None
    ) -> Iterator[Connection]:
        return _search.connections(self._connections.values(), topics, connection_filter)

    def _get_entries(
        self, connections: Iterable[Connection] | None = None, start_time: Any = None, end_time: Any = None
    ) -> Iterator[_views.IndexEntry]:
        return map(_views.entry_view, _search.entries(self, connections, start_time, end_time))

    def __indexes__(self, connections: Iterable[Connection] | None) -> list[list[Entry]]:
        """Return the entries of each connection."""
        indexes = self.__contents__().indexes
        return list(indexes.values()) if connections is None else [indexes[each.id] for each in connections]

    def _get_entries_reverse(
        self, connections: Iterable[Connection] | None = None, start_time: Any = None, end_time: Any = None
    ) -> Iterator[_views.IndexEntry]:
        return map(_views.entry_view, _search.entries_reverse(self, connections, start_time, end_time))

    def _get_entry(self, t: Any, connections: Iterable[Connection] | None = None) -> _views.IndexEntry | None:
        before = [
            index[place - 1]
            for index in self.__indexes__(connections)
            if (place := bisect_right(index, t.to_nsec(), key=_TIME)) > 0
        ]
        return _views.entry_view(max(before, key=_TIME)) if before else None

    def _get_entry_after(self, t: Any, connections: Iterable[Connection] | None = None) -> _views.IndexEntry | None:
        after = [
            index[place]
            for index in self.__indexes__(connections)
            if (place := bisect_right(index, t.to_nsec(), key=_TIME)) < len(index)
        ]
        return _views.entry_view(min(after, key=_TIME)) if after else None
