"""The content of a bag as rosbag shows it: tuples with ROS times in place of nanoseconds.

Imports rospy and rosbag_storage.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import rospy

if TYPE_CHECKING:
    from rosbag_storage import Chunk, Entry


class BagMessage(NamedTuple):
    """A message, the topic it was on, and when it was recorded (`rospy.Time`)."""

    topic: str
    message: Any
    timestamp: Any


class BagMessageWithConnectionHeader(NamedTuple):
    """A message with the header of the connection that it came over."""

    topic: str
    message: Any
    timestamp: Any
    connection_header: Any


class CompressionTuple(NamedTuple):
    """The compression of most chunks, and the bytes of all chunks without and with compression."""

    compression: str
    uncompressed: int
    compressed: int


class TopicTuple(NamedTuple):
    """Data of a topic. `frequency` in Hz is from the median of the periods, or None if there is none."""

    msg_type: str
    message_count: int
    connections: int
    frequency: float | None


class TypesAndTopicsTuple(NamedTuple):
    """The md5sum of each message type, and the data of each topic."""

    msg_types: dict[str, str]
    topics: dict[str, TopicTuple]


class IndexEntry(NamedTuple):
    """Where a message is."""

    time: Any
    chunk_pos: int
    offset: int

    @property
    def position(self) -> tuple[int, int]:
        """The position as `Bag._read_message` takes it."""
        return (self.chunk_pos, self.offset)


class ChunkInfo(NamedTuple):
    """A chunk: its position in the file, first and last time, messages by connection."""

    pos: int
    start_time: Any
    end_time: Any
    connection_counts: dict[int, int]


def ros_time(ns: int) -> Any:
    """Return a `rospy.Time` of so many ns."""
    return rospy.Time(ns // 1_000_000_000, ns % 1_000_000_000)


def entry_view(entry: Entry) -> IndexEntry:
    """Return an entry with a ROS time."""
    return IndexEntry(ros_time(entry.time), entry.chunk_pos, entry.offset)


def chunk_view(chunk: Chunk) -> ChunkInfo:
    """Return a chunk with ROS times."""
    return ChunkInfo(chunk.pos, ros_time(chunk.start), ros_time(chunk.end), chunk.connection_counts)
