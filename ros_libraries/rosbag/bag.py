"""`rosbag.Bag`: messages read from and written to a bag (rosbag's Python API).

Imports rospy, genpy, rosbag_storage and the modules beside it. Tools around rosbag use the names that begin with an
underscore.
"""

from __future__ import annotations

import io
import sys
import time
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

import genpy
from rosbag_storage import (
    BagFile,
    Connection,
    Entry,
    ROSBagEncryptException,
    ROSBagEncryptNotSupportedException,
    ROSBagException,
    ROSBagFormatException,
    ROSBagUnindexedException,
    opened,
    records,
)

from . import _info, _search, _views
from ._indexed import Indexed
from ._info import Compression
from ._search import Filter
from ._types import message_type
from ._views import BagMessage, BagMessageWithConnectionHeader

__all__ = [
    "Bag",
    "BagMessage",
    "BagMessageWithConnectionHeader",
    "Compression",
    "ROSBagEncryptException",
    "ROSBagEncryptNotSupportedException",
    "ROSBagException",
    "ROSBagFormatException",
    "ROSBagUnindexedException",
]

AES_CBC = "rosbag/AesCbcEncryptor"

_FILE_HEADER_LENGTH = records.FILE_HEADER_LENGTH
_OP_CODES = records.OP_CODES
_ENTERED = (
    "cfepy: a message on {topic} could not be serialized. As on ROS, the index of the bag counts it nevertheless: it is"
    " read as a copy of the next message in the file, or ends the reading if there is none."
)
_OP_FILE_HEADER = records.OP_FILE_HEADER
_pack_uint8, _pack_uint32, _pack_uint64 = records.pack_uint8, records.pack_uint32, records.pack_uint64
_read_header, _read_record_data, _read_sized = records.read_header, records.read_record_data, records.read_sized
_read_uint8_field = records.uint8_field
_write_record = records.write_record


class Bag(Indexed):
    """A bag.

    Args:
        f: name of the file, or an open binary file.
        mode: "r" to read, "w" to write a new one, "a" to append to one.
        compression: compression of written chunks; see `Compression`.
        chunk_threshold: size in bytes, without compression, at which a chunk ends.
        allow_unindexed: also open a bag that was not closed; `reindex` makes it readable.
        options: "compression" and "chunk_threshold" in a dictionary, which override the arguments.
        skip_index: read the positions of messages only when they are first needed.

    Raises:
        ValueError: an invalid argument.
        ROSBagException: it is not a bag; ROSBagUnindexedException if it was not closed.
        OSError: the file cannot be opened.
    """

    def __init__(
        self,
        f: Any,
        mode: str = "r",
        compression: str = Compression.NONE,
        chunk_threshold: int = 768 * 1024,
        allow_unindexed: bool = False,
        options: dict[str, Any] | None = None,
        skip_index: bool = False,
    ) -> None:
        if options is not None:
            if type(options) is not dict:
                raise ValueError("options must be of type dict")
            compression = options.get("compression", compression)
            chunk_threshold = options.get("chunk_threshold", chunk_threshold)
        _info.check_options(compression, chunk_threshold)
        if not f:
            raise ValueError("filename (or stream) is invalid")
        if mode not in ("r", "w", "a"):
            raise ValueError(f'mode "{mode}" is invalid')
        self._compression = compression
        self._chunk_threshold = chunk_threshold
        self._skip_index = skip_index
        self._mode = mode
        self._filename = None if isinstance(f, io.IOBase) else f
        if self._filename is None:
            f.mode  # noqa: B018  # a stream without it raises AttributeError, as in ROS
        self._file: Any = self.__open_file(f) if self._filename is not None else f
        self.__storage__ = opened(self._file) if mode == "r" else BagFile(self._file)
        self._topic_connections: dict[str, Connection] = {}
        self._connection_indexes_read = mode != "w"
        self.__begin(allow_unindexed)

    def __open_file(self, name: Any) -> Any:
        if self._mode != "a":
            return open(name, "rb" if self._mode == "r" else "w+b")  # closed by `close`
        try:
            return open(name, "r+b")
        except OSError:
            return open(name, "w+b")

    def __begin(self, allow_unindexed: bool) -> None:
        try:
            if self._mode == "w":
                self.__storage__.create()
            else:
                self.__storage__.read_version()
                self.__read_index(allow_unindexed)
        except BaseException:
            self._close_file()
            raise

    def __read_index(self, allow_unindexed: bool) -> None:
        try:
            self.__storage__.open(with_entries=not self._skip_index)
            self._connection_indexes_read = not self._skip_index
            if self._mode == "a":
                self.__storage__.append()
        except ROSBagUnindexedException:
            if not allow_unindexed:
                raise

    # -- properties --------------------------------------------------------------------------------------------------

    @property
    def options(self) -> dict[str, Any]:
        """Compression and chunk threshold."""
        return {"compression": self._compression, "chunk_threshold": self._chunk_threshold}

    @property
    def filename(self) -> Any:
        """Name of the file, None for a stream."""
        return self._filename

    @property
    def version(self) -> int:
        """Version of the format, 200 for 2.0."""
        return self.__storage__.version

    @property
    def mode(self) -> str:
        """ "r", "w" or "a"."""
        return self._mode

    @property
    def size(self) -> int:
        """Bytes of the file, including unwritten data."""
        self.__opened__()
        return self.__size__()

    @property
    def compression(self) -> str:
        """Compression of data written from now on; see `Compression`."""
        return self._compression

    @compression.setter
    def compression(self, compression: str) -> None:
        _info.check_options(compression, self._chunk_threshold)
        self.flush()
        self._compression = compression

    @property
    def chunk_threshold(self) -> int:
        """Size in bytes at which a chunk ends."""
        return self._chunk_threshold

    @chunk_threshold.setter
    def chunk_threshold(self, chunk_threshold: int) -> None:
        _info.check_options(self._compression, chunk_threshold)
        self.flush()
        self._chunk_threshold = chunk_threshold

    def __iter__(self) -> Iterator[Any]:
        return self.read_messages()

    def __enter__(self) -> Bag:
        return self

    def __exit__(self, exc_type: Any, exc_value: Any, traceback: Any) -> None:
        self.close()

    def __str__(self) -> str:
        """Return the output of `rosbag info`."""
        return _info.text_of(self)

    def get_message_count(self, topic_filters: str | list[str] | None = None) -> int:
        """Return how many messages there are, on some topics or on all."""
        if topic_filters is not None:
            topics = self.get_type_and_topic_info(topic_filters).topics
            return sum(topic.message_count for topic in topics.values())
        return _info.count(self.__all_chunks__(), self._connections.values())

    def get_start_time(self) -> float:
        """Return the time of the first message in s. Raises ROSBagException if there is none."""
        return _info.times_of(self.__all_chunks__())[0]

    def get_end_time(self) -> float:
        """Return the time of the last message in s. Raises ROSBagException if there is none."""
        return _info.times_of(self.__all_chunks__())[1]

    def get_type_and_topic_info(self, topic_filters: str | list[str] | None = None) -> _views.TypesAndTopicsTuple:
        """Return the types of messages, and the data of each topic (or of some topics)."""
        return _info.types_and_topics(self, topic_filters)

    def get_compression_info(self) -> _views.CompressionTuple:
        """How most chunks are compressed, and the bytes of all without and with compression."""
        return _info.compression_of(self.__storage__.contents.chunks, self._compression)

    # -- reading -----------------------------------------------------------------------------------------------------

    def read_messages(
        self,
        topics: str | Iterable[str] | None = None,
        start_time: Any = None,
        end_time: Any = None,
        connection_filter: Filter | None = None,
        raw: bool = False,
        return_connection_header: bool = False,
    ) -> Iterator[Any]:
        """Return the messages, ordered by time.

        Args:
            topics: one topic or several; all if there are none.
            start_time: `rospy.Time` of the earliest.
            end_time: `rospy.Time` of the latest.
            connection_filter: takes (topic, type, md5sum, definition, connection header) and returns whether to read
                messages of that connection.
            raw: give (type, bytes, md5sum, position, class) in place of the message.
            return_connection_header: give the connection header as well.

        Returns:
            An iterator of `BagMessage`, or of `BagMessageWithConnectionHeader`.
        """
        self.flush()
        entries = _search.entries(self, self._get_connections(topics, connection_filter), start_time, end_time)
        return (self.__message_at(entry, raw, return_connection_header) for entry in entries)

    def __message_at(self, entry: Entry | tuple[int, int], raw: bool, with_header: bool) -> Any:
        connection, ns, data = self.__storage__.read(entry)
        kind = message_type(connection)
        message: Any = (connection.datatype, data, connection.md5sum, tuple(entry[-2:]), kind)
        if not raw:
            message = kind()
            message.deserialize(data)
        stamp = _views.ros_time(ns)
        if with_header:
            return BagMessageWithConnectionHeader(connection.topic, message, stamp, connection.header)
        return BagMessage(connection.topic, message, stamp)

    def _read_message(
        self, position: tuple[int, int], raw: bool = False, return_connection_header: bool = False
    ) -> Any:
        """Return the message at the position of an index entry."""
        self.flush()
        return self.__message_at(position, raw, return_connection_header)

    def _get_yaml_info(self, key: str | None = None) -> Any:
        """Return the output of `rosbag info --yaml`, or one value of it."""
        return _info.yaml_of(self, key)

    # -- writing -----------------------------------------------------------------------------------------------------

    def write(
        self, topic: str, msg: Any, t: Any = None, raw: bool = False, connection_header: Mapping[str, Any] | None = None
    ) -> None:
        """Write a message.

        Args:
            topic: name of the topic.
            msg: the message; with `raw`, (type, bytes, md5sum, class), or the same with a position before the class.
            t: `rospy.Time` of it; None is now.
            raw: see `msg`.
            connection_header: written unchanged with the topic's first message, and ignored later; None makes one.

        Raises:
            ValueError: no topic, no message, or the bag is closed.
            io.UnsupportedOperation: the bag was opened to read.
            ROSBagException: the class of a raw message is unknown.
            SerializationError: a field has a value that its type cannot carry. As in ROS, the index then has an entry
                for the message, which leads to the next one in the file.
        """
        self.__opened__()
        if not topic:
            raise ValueError("topic is invalid")
        if not msg:
            raise ValueError("msg is invalid")
        if self._mode == "r":
            raise io.UnsupportedOperation("write")
        if t is None:
            t = genpy.Time.from_sec(time.time())
        data, header = _search.raw_parts(topic, msg) if raw else _search.message_parts(topic, msg)
        connection = self._topic_connections.get(topic)
        if connection is None:
            if not isinstance(topic, str | bytes):
                topic.encode()  # AttributeError as in ROS
            made = connection_header if connection_header is not None else header()
            connection = self.__storage__.connect(topic, made, self._compression)
            self._topic_connections[topic] = connection
        stamp = t.secs * 1_000_000_000 + t.nsecs
        try:
            content = data()
        except Exception:
            self.__storage__.enter(connection, stamp, self._compression)
            print(_ENTERED.format(topic=topic), file=sys.stderr)
            raise
        size = self.__storage__.write(connection, stamp, content, self._compression)
        if size > self._chunk_threshold:
            self.flush()

    def flush(self) -> None:
        """Write buffered data to the file; ValueError if the bag is closed."""
        self.__opened__()
        self.__storage__.flush()

    def reindex(self) -> Iterator[int]:
        """Rebuild the index of a bag. Iterate over the result to do it; it yields the positions of the chunks."""
        self._file.seek(0, 1)  # AttributeError if the bag is closed, as in ROS
        self.flush()
        self._topic_connections.clear()
        self._connection_indexes_read = not isinstance(self.__storage__, BagFile)
        yield from self.__storage__.reindex()

    def close(self) -> None:
        """Close the bag. Further calls do nothing."""
        if self._file is None:
            return
        try:
            if self._mode in "wa":
                self.__storage__.finish()
        finally:
            self._close_file()

    def set_encryptor(self, encryptor: str | None = None, param: str | None = None) -> None:
        """Set the encryption of written data, which is not supported here.

        Raises:
            ROSBagException: there are chunks already.
            ROSBagEncryptNotSupportedException: an encryptor was given.
        """
        if self.__storage__.contents.chunks:
            raise ROSBagException("Cannot set encryptor after chunks are written")
        if encryptor == AES_CBC:
            raise ROSBagEncryptNotSupportedException("AES CBC encryptor is not supported on the simulated computer")

    def __opened__(self) -> Any:
        if self._file is None:
            raise ValueError("I/O operation on closed bag")
        return self._file

    def _close_file(self) -> None:
        self._file.close()
        self._file = None
