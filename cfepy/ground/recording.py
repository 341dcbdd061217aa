"""A whole recording, a bag or an MCAP file, possibly damaged: its contents, and a rewritten copy of the readable part.

For example:

    summary_of("run.mcap").text()
    rewrite("cut.bag", "whole.bag")  # the readable part
    rewrite("run.mcap", "run.bag", strict=True)  # a conversion: nothing may be lost
"""

from __future__ import annotations

import mmap
import os
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, BinaryIO

from cfepy.ground.bag import CHUNK_BYTES, storage
from cfepy.ground.json_packets import PACKETS
from cfepy.ground.mcap_writer import COMPRESSIONS, McapWriter
from cfepy.mission import described
from cfepy.reading.input_files import open_input
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from rosbag_storage import Connection, Loss, RecordedChannel, RecordedMessage, Salvage

BAG, MCAP = ".bag", ".mcap"
KINDS = {BAG: ("none", "bz2", "lz4"), MCAP: COMPRESSIONS}
"""Compressions of chunks in each format."""
_BEGINNINGS = {b"#ROSBAG": BAG, b"\x89MCAP0\r": MCAP}
_ROS_TIME_NS = (1 << 32) * NS_PER_S


@dataclass
class TopicSummary:
    """A topic of a recording.

    Attributes:
        topic: name.
        type: type of its messages.
        encoding: "ros1", or another encoding in an MCAP file.
        connections: number of publishers, or channels.
        messages: number of readable messages.
        bytes: bytes of these.
        lost: number of messages in the file's index that cannot be read; None without an index.
        left_out: number of messages that the other format cannot store.
    """

    topic: str
    type: str
    encoding: str
    connections: int = 0
    messages: int = 0
    bytes: int = 0
    lost: int | None = None
    left_out: int = 0


@dataclass
class RecordingSummary:
    """Contents of a recording.

    Attributes:
        file: name of the file.
        format: ".bag" or ".mcap".
        size: size in bytes.
        finished: whether it has its end and index.
        start_ns: time of the first message, in ns; None without messages.
        end_ns: time of the last message, in ns; None without messages.
        chunks: number of chunks, by compression.
        topics: the topics, sorted by name.
        losses: parts that could not be read.
        doubtful: number of messages in chunks with a wrong checksum.
        metadata: metadata of an MCAP file, by name.
    """

    file: str
    format: str
    size: int
    finished: bool = False
    start_ns: int | None = None
    end_ns: int | None = None
    chunks: dict[str, int] = field(default_factory=dict)
    topics: list[TopicSummary] = field(default_factory=list)
    losses: list[Loss] = field(default_factory=list)
    doubtful: int = 0
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)

    @property
    def messages(self) -> int:
        """Number of readable messages."""
        return sum(each.messages for each in self.topics)

    @property
    def is_whole(self) -> bool:
        """Whether the file has no errors."""
        return self.finished and not self.losses and not any(each.lost for each in self.topics)

    def to_dict(self) -> dict[str, Any]:
        """Return it as plain values."""
        plain = {name: value for name, value in vars(self).items() if name not in ("topics", "losses")}
        topics, losses = ([dict(vars(each)) for each in found] for found in (self.topics, self.losses))
        return {**plain, "messages": self.messages, "topics": topics, "losses": losses}

    def damage(self) -> Iterator[str]:
        """Return the errors of the file, a line each."""
        for loss in self.losses:
            yield f"{loss.size:,} bytes at byte {loss.at:,}{_between(loss)}: {loss.why}"
        if self.doubtful:
            yield f"{self.doubtful:,} messages of chunks with a wrong checksum can be read, and may be altered"
        for each in self.topics:
            if each.lost:
                yield f"{each.lost:,} messages of {each.topic} are lost"
        if not self.finished:
            unknown = "" if any(each.lost is not None for each in self.topics) else "; how much is missing is not known"
            yield f"the recording was not finished, or its index is damaged{unknown}"


def _between(loss: Loss) -> str:
    """Return the messages around a loss, by their times in s."""
    sides = (("after", loss.after), ("before", loss.before))
    said = " and ".join(f"{side} {at / NS_PER_S:.6f}" for side, at in sides if at is not None)
    return f", {said}" if said else ""


class _Count:
    """Counts the messages of a recording while they are read."""

    def __init__(self, summary: RecordingSummary, salvage: Salvage) -> None:
        self._summary, self._salvage = summary, salvage
        self._bytes: dict[RecordedChannel, int] = {}

    def messages(self) -> Iterator[RecordedMessage]:
        """Yield the messages that are left."""
        summary = self._summary
        for message in self._salvage.messages():
            time = message.time
            summary.start_ns = time if summary.start_ns is None else min(summary.start_ns, time)
            summary.end_ns = time if summary.end_ns is None else max(summary.end_ns, time)
            self._bytes[message.channel] = self._bytes.get(message.channel, 0) + len(message.data)
            yield message
        self._conclude()

    def _conclude(self) -> None:
        summary, salvage = self._summary, self._salvage
        summary.finished, summary.losses, summary.doubtful = salvage.finished, salvage.losses, salvage.doubtful
        summary.chunks, summary.metadata = dict(salvage.chunks), dict(salvage.metadata)
        topics: dict[tuple[str, str, str], TopicSummary] = {}
        for channel in salvage.channels.values():
            key = (channel.topic, channel.schema.name, channel.encoding)
            row = topics.setdefault(key, TopicSummary(*key))
            row.connections += 1
            row.messages += salvage.counts[channel]
            row.bytes += self._bytes.get(channel, 0)
            if salvage.expected is not None:
                missing = salvage.expected.get(channel.id, 0) - salvage.counts[channel]
                row.lost = (row.lost or 0) + max(0, missing)
        summary.topics = [topics[key] for key in sorted(topics)]


@contextmanager
def _opened(file: str) -> Iterator[tuple[RecordingSummary, Salvage]]:
    """Opens a recording without trusting its contents."""
    try:
        with open_input(file) as stream:
            size = os.fstat(stream.fileno()).st_size
            data = mmap.mmap(stream.fileno(), 0, access=mmap.ACCESS_READ) if size else None
    except (OSError, ValueError) as error:
        why = error.strerror if isinstance(error, OSError) else error
        raise UsageError(f"could not be read: {why}", file=file) from None
    if data is None:
        raise UsageError("is empty", file=file)
    with data:
        kind = _BEGINNINGS.get(data[:7]) or Path(file).suffix
        if kind not in KINDS:
            raise UsageError("is not a bag or an MCAP file", file=file)
        salvage = storage().BagSalvage(data) if kind == BAG else storage().McapSalvage(data)
        try:
            yield RecordingSummary(file, kind, size), salvage
        except UsageError:  # UsageError is a ValueError too
            raise
        except ImportError as error:
            raise UsageError(str(error), file=file) from None
        except (*storage().BROKEN, struct.error, OverflowError) as error:
            raise UsageError(f"is broken: {described(error)}", file=file) from None


def summary_of(file: str) -> RecordingSummary:
    """Return the contents of a recording, and its errors.

    Args:
        file: a bag or an MCAP file, which may be damaged.

    Raises:
        UsageError: if there is none, or support for its compression is not installed.
    """
    with _opened(file) as (summary, salvage):
        for _ in _Count(summary, salvage).messages():
            pass
    return summary


def packets_of(file: str) -> Iterator[RecordedMessage]:
    """Yield the packets of cFE in an MCAP file, as JSON (`cfepy.ground.json_packets`); none in a bag.

    Raises:
        UsageError: if the file cannot be read, or is damaged.
    """
    with _opened(file) as (_, salvage):
        for message in salvage.messages():
            channel = message.channel
            if channel.encoding == "json" and channel.topic.startswith(PACKETS) and "msg_id" in channel.metadata:
                yield message


def rewrite(file: str, output: str, compression: str | None = None, strict: bool = False) -> RecordingSummary:
    """Write the contents of a recording to another file, whose name determines the format.

    Messages keep their bytes, times, connections and order. Data that a bag cannot store is left out: channels of an
    MCAP file that are no topics of ROS 1, its metadata and attachments.

    Args:
        file: a bag or an MCAP file.
        output: the new file, which is created only on success; it may be the same one.
        compression: one of `KINDS` of its format; None for no compression.
        strict: whether losses are an error.

    Returns:
        The contents of the recording.

    Raises:
        UsageError: if there is no such recording, nothing is left of it, the file cannot be written, or, if `strict`,
            something is lost.
    """
    kind = Path(output).suffix
    if kind not in KINDS:
        raise UsageError("must end with .bag or .mcap", file=output, field="--output")
    chosen = compression or "none"
    if chosen not in KINDS[kind]:
        text = f"unknown compression {chosen} for a file {kind}; expected {', '.join(KINDS[kind])}"
        raise UsageError(text, field="--compression")
    part = f"{output}.part"
    try:
        with _opened(file) as (summary, salvage), _written(part, output, kind, chosen) as target:
            _copy(summary, salvage, target, strict)
        os.replace(part, output)
    except OSError as error:
        raise UsageError(f"could not be written: {error.strerror}", file=output, field="--output") from None
    finally:
        Path(part).unlink(missing_ok=True)
    return summary


def _copy(summary: RecordingSummary, salvage: Salvage, target: _BagTarget | _McapTarget, strict: bool) -> None:
    left_out: dict[tuple[str, str, str], int] = {}
    for message in _Count(summary, salvage).messages():
        if not target.write(message):
            key = (message.channel.topic, message.channel.schema.name, message.channel.encoding)
            left_out[key] = left_out.get(key, 0) + 1
        if strict and salvage.losses:
            break
    if strict and (salvage.losses or not summary.is_whole):
        loss = next(iter(salvage.losses), None)
        why = next(summary.damage()) if loss is None else f"{loss.why} (byte {loss.at:,})"
        raise UsageError(
            f"is damaged: {why}; cfepy rosbag recover {summary.file} saves the readable messages", file=summary.file
        )
    if not summary.messages and not strict:
        why = next(iter(summary.damage()), "it has no messages")
        raise UsageError(f"has no readable message: {why}", file=summary.file)
    for row in summary.topics:
        row.left_out = left_out.get((row.topic, row.type, row.encoding), 0)
    target.finish(salvage)


class _BagTarget:
    """A bag to write."""

    def __init__(self, file: BinaryIO, compression: str) -> None:
        self._bag = storage().BagFile(file)
        self._bag.create()
        self._kind = compression
        self._connections: dict[RecordedChannel, Connection] = {}

    def write(self, message: RecordedMessage) -> bool:
        """Write a message; returns whether a bag can store it."""
        source = message.channel.connection
        if source is None or message.time >= _ROS_TIME_NS:
            return False
        known = self._connections.get(message.channel)
        if known is None:
            known = self._connections[message.channel] = self._bag.connect(source.topic, source.header, self._kind)
        if self._bag.write(known, message.time, message.data, self._kind) > CHUNK_BYTES:
            self._bag.flush()
        return True

    def finish(self, salvage: Salvage) -> None:
        """Write the index."""
        self._bag.finish()


class _McapTarget:
    """An MCAP file to write."""

    def __init__(self, file: BinaryIO, compression: str) -> None:
        self._writer = McapWriter(file, compression)
        self._channels: dict[RecordedChannel, int] = {}

    def write(self, message: RecordedMessage) -> bool:
        """Write a message; returns True, because all can be stored."""
        channel = message.channel
        if channel not in self._channels:
            self._channels[channel] = self._writer.channel(channel)
        self._writer.write(self._channels[channel], message.time, message.data, message.publish_time, message.sequence)
        return True

    def finish(self, salvage: Salvage) -> None:
        """Write the attachments and the index."""
        for name, values in salvage.metadata:
            self._writer.metadata(name, values)
        for attachment in salvage.attachments:
            self._writer.attachment(*attachment)
        self._writer.finish()


@contextmanager
def _written(part: str, output: str, kind: str, compression: str) -> Iterator[_BagTarget | _McapTarget]:
    try:
        with Path(part).open("w+b") as stream:
            yield _BagTarget(stream, compression) if kind == BAG else _McapTarget(stream, compression)
    except OSError as error:
        raise UsageError(f"could not be written: {error.strerror}", file=output, field="--output") from None
