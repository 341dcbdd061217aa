"""The index of a bag for tools around rosbag, with rosbag's names. Imports rosbag_storage."""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from typing import Any

from rosbag_storage import BagFile, Chunk, Connection, Contents

from . import _search, _views
from ._search import Filter


class Indexed:
    """The index of a `Bag`.

    `_connection_indexes_read` is true if the positions of messages have been read from the file. As in ROS, a bag that
    is written or was indexed anew knows them already (`__knows_entries__`), and then has each of them twice.
    """

    __storage__: BagFile
    _connection_indexes_read: bool
    __knows_entries__: bool

    def flush(self) -> None:
        """See `Bag.flush`."""
        raise NotImplementedError

    def __contents__(self) -> Contents:
        """Return the contents, with the entries."""
        self.flush()
        if not self._connection_indexes_read:
            self._connection_indexes_read = True
            if self.__knows_entries__:
                self.__storage__.contents.double()
            else:
                self.__storage__.read_entries()
        return self.__storage__.contents

    def __all_chunks__(self) -> list[Chunk]:
        """Return the chunks, with the one that is being written."""
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
        return sum(chunk.size for chunk in self.__storage__.contents.chunks) or self.__storage__.file.seek(0, 2)

    @property
    def _has_compressed_chunks(self) -> bool:
        return any(chunk.compression != "none" for chunk in self.__storage__.contents.chunks)

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

    def _get_entries_reverse(
        self, connections: Iterable[Connection] | None = None, start_time: Any = None, end_time: Any = None
    ) -> Iterator[_views.IndexEntry]:
        return iter(list(self._get_entries(connections, start_time, end_time))[::-1])

    def _get_entry(self, t: Any, connections: Iterable[Connection] | None = None) -> _views.IndexEntry | None:
        return next(self._get_entries_reverse(connections, end_time=t), None)

    def _get_entry_after(self, t: Any, connections: Iterable[Connection] | None = None) -> _views.IndexEntry | None:
        return next((entry for entry in self._get_entries(connections, start_time=t) if entry.time > t), None)
