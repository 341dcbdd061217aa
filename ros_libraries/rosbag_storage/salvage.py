"""Recovers a damaged recording: its messages in the order of the file, and the parts that could not be read.

Nothing in the file is trusted before it is verified. After a damaged or truncated record, the next one is searched byte
by byte. `BagSalvage` does so for bags. Imports what the package has.
"""

from __future__ import annotations

import struct
from abc import ABC, abstractmethod
from collections import Counter
from collections.abc import Generator, Iterator
from dataclasses import dataclass
from mmap import mmap
from typing import Any, NamedTuple

from . import compression, index, records
from .contents import Connection
from .errors import ROSBagEncryptNotSupportedException, ROSBagException
from .mcap_records import RecordedChannel, RecordedMessage, channel_of_connection
from .md5sums import md5sum_of

Bytes = bytes | mmap
BROKEN = (ROSBagException, ValueError, LookupError, OSError, EOFError)
CUT_OFF = "the data of a chunk are cut off"
_PIECE = 1024  # bytes that are decompressed at once: the result fits into memory
_LONGEST_HEADER = 1 << 16
_NAMES = (b"op=", b"conn=", b"time=", b"ver=", b"count=", b"topic=", b"compression=", b"size=")
"""Of fields of headers: in one that is damaged in one place, the first or the second one stands where it is to be."""
_FIELD_OF = {
    records.OP_FILE_HEADER: "index_pos",
    records.OP_INDEX_DATA: "count",
    records.OP_CHUNK: "compression",
    records.OP_CHUNK_INFO: "chunk_pos",
}
"""A field that records of a kind have, and others do not: by it one is known whose kind is damaged."""
_FARTHEST_OP = 128  # bytes of a header before its field `op`; writers have at most three short ones there


@dataclass
class Loss:
    """A part of a file that could not be read.

    Attributes:
        at: the byte at which it begins.
        size: in bytes; for a compressed chunk, of the compressed data.
        why: the reason.
        after, before: times in ns of the last message before it and of the first one behind it; None without one.
    """

    at: int
    size: int
    why: str
    after: int | None = None
    before: int | None = None


class Salvage(ABC):
    """Reads a recording in any state.

    Args:
        data: the whole file.

    Attributes:
        losses: the unreadable parts so far.
        counts: messages so far, by channel.
        expected: number of messages according to the file's own index, by number of the channel; None without one.
        doubtful: messages of chunks whose checksum is wrong: they can be read, and may be altered.
        finished: the file has its end and its index.
        chunks: how many there are, by compression.
        metadata, attachments: other contents of an MCAP file.
    """

    def __init__(self, data: Bytes) -> None:
        self.data = data
        self.losses: list[Loss] = []
        self.counts: Counter[RecordedChannel] = Counter()
        self.channels: dict[int, RecordedChannel] = {}
        self.expected: dict[int, int] | None = None
        self.doubtful = 0
        self.finished = False
        self.chunks: Counter[str] = Counter()
        self.metadata: list[tuple[str, dict[str, str]]] = []
        self.attachments: list[tuple[int, int, str, str, bytes]] = []

    def messages(self) -> Iterator[RecordedMessage]:
        """Yield the recovered messages in the order of the file. The counts are right after the last one."""
        last: int | None = None
        told = 0
        for message in self._messages():
            for loss in self.losses[told:]:
                loss.after, loss.before = last, message.time
            told, last = len(self.losses), message.time
            self.counts[message.channel] += 1
            yield message
        for loss in self.losses[told:]:
            loss.after = last

    @abstractmethod
    def _messages(self) -> Iterator[RecordedMessage]:
        """Yield the recovered messages, and record losses, counts and doubtful messages."""

    def _lose(self, at: int, end: int, why: object) -> None:
        """Record bytes that could not be read. Adjacent ones are one loss."""
        before = self.losses[-1] if self.losses else None
        if before is not None and before.size and before.at + before.size == at:
            before.size += end - at
        else:
            self.losses.append(Loss(at, end - at, str(why)))


def beginning_of(kind: str, stored: bytes) -> tuple[bytes, str]:
    """Return the decompressible part of a chunk's data, and why the rest is unreadable, or "" if it is complete.

    Raises:
        ImportError: its decompressor is not installed.
    """
    if kind == compression.NONE:
        return stored, ""
    if kind == compression.LZ4:
        return _beginning_of_lz4(stored)
    unpacker = _unpacker(kind)
    found = bytearray()
    try:
        for at in range(0, len(stored), _PIECE):
            found += unpacker.decompress(stored[at : at + _PIECE])
            if len(found) > compression.LARGEST:
                return bytes(found), "a chunk is too large"
            if unpacker.eof:
                return bytes(found), ""
    except ImportError:
        raise
    except Exception as error:  # each of the libraries has its own
        return bytes(found), f"the data of a chunk are damaged: {error}"
    return bytes(found), CUT_OFF


def _beginning_of_lz4(stored: bytes) -> tuple[bytes, str]:
    """Return the same as `beginning_of`, and include an incomplete block."""
    from . import lz4_frames

    try:
        found, is_whole = lz4_frames.unpacked(stored, compression.LARGEST + 1)
    except RuntimeError as error:
        return lz4_frames.beginning(stored, compression.LARGEST), f"the data of a chunk are damaged: {error}"
    if len(found) > compression.LARGEST:
        return found, "a chunk is too large"
    return (found, "") if is_whole else (lz4_frames.beginning(stored, compression.LARGEST), CUT_OFF)


def _unpacker(kind: str) -> Any:
    if kind == compression.BZ2:
        import bz2

        return bz2.BZ2Decompressor()
    if kind == compression.ZSTD:
        return compression.zstd().ZstdDecompressor().decompressobj()
    raise ROSBagException(f"unsupported compression type: {kind}")


# -- bags --------------------------------------------------------------------------------------------------------------


class _Record(NamedTuple):
    """A record of a bag: where it is, its header, where its data begin and end."""

    at: int
    op: int
    fields: dict[str, bytes]
    data_at: int
    end: int


def _record_at(data: Bytes, at: int) -> _Record:
    """Return the record that begins at a byte. Its data may extend behind the end of the file.

    Raises:
        ROSBagException: there is no record.
    """
    head = int.from_bytes(data[at : at + 4], "little")
    header_end = at + 4 + head
    if head == 0 or head > _LONGEST_HEADER or header_end + 4 > len(data):
        raise ROSBagException(f"no record at byte {at:,}")
    fields = records.split_header(data[at + 4 : header_end])
    size = int.from_bytes(data[header_end : header_end + 4], "little")
    return _Record(at, records.uint8_field(fields, "op"), fields, header_end + 4, header_end + 4 + size)


def _fits(connection: Connection) -> int:
    """Return how many parts of a connection bear each other out: its topic and its type are in it twice."""
    topics = (None, connection.topic, connection.topic.encode())
    sums = ("*", connection.md5sum)
    return (connection.header.get("topic") in topics) + (md5sum_of(connection.datatype, connection.msg_def) in sums)


class BagSalvage(Salvage):
    """Recovery of a damaged bag; see `Salvage`."""

    def __init__(self, data: Bytes) -> None:
        super().__init__(data)
        self._scores: dict[int, tuple[int, bool]] = {}  # of the connections in `channels`: how well they fit

    def _messages(self) -> Iterator[RecordedMessage]:
        data, end = self.data, len(self.data)
        self._read_index()
        at = len(records.VERSION)
        if data[:at] != records.VERSION:
            at = self._resync(0, "the file does not begin like a bag")
        while at < end:
            try:
                record = _record_at(data, at)
                if record.op == records.OP_CHUNK:
                    at = yield from self._chunk(record)
                    continue
                if record.end > end:
                    raise ROSBagException(f"a record ends behind the file, at byte {at:,}")
                if record.op == records.OP_CONNECTION:
                    self._connect(data, record)
                elif record.op not in records.OP_CODES or record.op == records.OP_MSG_DATA:
                    raise ROSBagException(f"a record of the kind {record.op} in between, at byte {at:,}")
                at = record.end
            except ImportError:
                raise
            except BROKEN as error:
                at = self._resync(at, error)

    def _resync(self, at: int, why: object) -> int:
        """Return the next position where a record certainly begins."""
        ops = (records.OP_CHUNK, records.OP_INDEX_DATA, records.OP_CONNECTION, records.OP_CHUNK_INFO)
        found = _next_record(self.data, at + 1, len(self.data), ops)
        self._lose(at, found, why)
        return found

    def _read_index(self) -> None:
        """Read connections and numbers of messages from the end of the file, if it is present."""
        data = self.data
        try:
            head = _record_at(data, len(records.VERSION))
            if head.fields.get("encryptor"):
                raise ROSBagEncryptNotSupportedException("the bag is encrypted, which is not supported")
            at = index.position(head.fields)
            counts: Counter[int] = Counter()
            for _ in range(records.uint32_field(head.fields, "conn_count")):
                record = _record_at(data, at)
                self._connect(data, record, is_of_index=True)
                at = record.end
            for _ in range(records.uint32_field(head.fields, "chunk_count")):
                record = _record_at(data, at)
                for number, count in records.pair.iter_unpack(data[record.data_at : record.end]):
                    counts[number] += count
                at = record.end
        except ROSBagEncryptNotSupportedException:
            raise
        except (*BROKEN, struct.error):
            return
        self.expected = dict(counts)
        self.finished = at == len(data)

    def _connect(self, data: Bytes, record: _Record, is_of_index: bool = False) -> None:
        """Add a connection. If two have the same number, the chunk's counts, unless the other fits better.

        No checksum shows which one is damaged, because bags have none.
        """
        number, topic = records.uint32_field(record.fields, "conn"), records.text_field(record.fields, "topic")
        connection = Connection(number, topic, records.split_header(data[record.data_at : record.end]))
        score = (_fits(connection), not is_of_index)
        before = self.channels.get(number)
        if before is None or (score > self._scores[number] and not self.counts[before]):
            self._scores[number] = score
            self.channels[number] = channel_of_connection(connection)

    def _chunk(self, record: _Record) -> Generator[RecordedMessage, None, int]:
        """Yield the messages of a chunk. Returns the position of the next record."""
        data, end = self.data, len(self.data)
        kind = records.text_field(record.fields, "compression")
        size = records.uint32_field(record.fields, "size")
        if kind not in compression.ALL:
            raise ROSBagException(f"a chunk is compressed by {kind[:20]!r}, which is not known, at byte {record.at:,}")
        self.chunks[kind] += 1
        if kind == compression.NONE:
            stop = record.end if record.end == record.data_at + size else -1
            lost = len(self.losses)
            found = yield from self._walk(data, record.data_at, stop, record.data_at)
            if found != stop and len(self.losses) == lost:
                self._lose(record.at, record.at, f"the stated length of a chunk does not match, at byte {record.at:,}")
            return found
        stored = data[record.data_at : min(record.end, end)]
        unpacked, why = beginning_of(kind, stored)
        lost = len(self.losses)
        is_doubtful = kind == compression.LZ4 and why not in ("", CUT_OFF)  # data recovered from bz2 has been checked
        yield from self._walk(unpacked, 0, len(unpacked), None, is_doubtful)
        if why or len(unpacked) != size or len(self.losses) > lost:
            why = why or f"a chunk of {size:,} bytes is damaged"
            self.losses[lost:] = [Loss(record.at, min(record.end, end) - record.at, f"{why}, at byte {record.at:,}")]
        if record.end == end or _is_record(data, record.end):
            return record.end
        return self._resync(record.data_at, "the stated length of a chunk does not match")

    def _walk(
        self, data: Bytes, at: int, stop: int, place: int | None, is_doubtful: bool = False
    ) -> Generator[RecordedMessage, None, int]:
        """Yield the messages in the records of a chunk. Returns where they end.

        Args:
            data: the bytes: of the chunk, or of the file if they are not compressed.
            at: where they begin.
            stop: where they should end.
            place: where they begin in the file; None if they are compressed.
            is_doubtful: a checksum is wrong.
        """
        end = len(data)
        while at != stop and at < end:
            try:
                record = _record_at(data, at)
                if record.op not in (records.OP_CONNECTION, records.OP_MSG_DATA):
                    if place is not None and _FIELD_OF.get(record.op) in record.fields and record.end <= end:
                        break  # the chunk is shorter than its header claims
                    raise ROSBagException(f"a record of the kind {record.op} in a chunk, at byte {at:,}")
                if record.end > end:
                    raise ROSBagException(f"a message is cut off, at byte {at:,}")
                if record.end not in (stop, end) and not _begins_record(data, record.end):
                    raise ROSBagException(f"the stated length of a message does not match, at byte {at:,}")
                if record.op == records.OP_CONNECTION:
                    self._connect(data, record)
                else:
                    message = self._message(data, record)
                    self.doubtful += is_doubtful
                    yield message
                at = record.end
            except BROKEN as error:
                ops = [records.OP_CONNECTION, records.OP_MSG_DATA]
                if place is not None:
                    ops += [records.OP_CHUNK, records.OP_INDEX_DATA]
                found = _next_record(data, at + 1, end, ops)
                found = stop if at < stop < found else found
                self._lose(at, found, error)
                at = found
        return at

    def _message(self, data: Bytes, record: _Record) -> RecordedMessage:
        number = records.uint32_field(record.fields, "conn")
        if number not in self.channels:
            raise ROSBagException(f"the connection {number} of a message is lost, at byte {record.at:,}")
        time = records.time_field(record.fields, "time")
        return RecordedMessage(self.channels[number], time, bytes(data[record.data_at : record.end]), time)


def _is_record(data: Bytes, at: int) -> bool:
    try:
        return _record_at(data, at).op in records.OP_CODES
    except BROKEN:
        return False


def _begins_record(data: Bytes, at: int) -> bool:
    """Return whether a record begins at a byte. A truncated or damaged one is recognised by the rest of its header."""
    if _is_record(data, at):
        return True
    rest = bytes(data[at : at + _FARTHEST_OP])
    head = int.from_bytes(rest[:4], "little")
    if head > _LONGEST_HEADER:  # no writer makes such a header: its length may be damaged in its upper half
        return _is_header(bytes(data[at + 4 : at + 4 + head % _LONGEST_HEADER]))
    if at + 4 + head + 4 > len(data) and _is_beginning(rest[4 : 4 + head]):
        return True
    second = 12 + int.from_bytes(rest[4:8], "little")  # behind the lengths of header, first and second field
    return rest[second:].startswith(_NAMES) or (
        rest[8:].startswith(_NAMES) and sum(name in rest for name in _NAMES) > 1
    )


def _is_header(header: bytes) -> bool:
    try:
        return b"op=" in header and records.uint8_field(records.split_header(header), "op") in records.OP_CODES
    except BROKEN:
        return False


def _is_beginning(header: bytes) -> bool:
    """Return whether bytes are the beginning of a header: fields, of which the last may be truncated."""
    while len(header) > 4:
        size = int.from_bytes(header[:4], "little")
        name = header[4 : 4 + size].partition(b"=")[0]
        if not name.isalpha() and not name.replace(b"_", b"").isalpha():
            return False
        header = header[4 + size :]
    return True


def _next_record(data: Bytes, at: int, end: int, ops: tuple[int, ...] | list[int]) -> int:
    """Return where the next record of some kinds begins, or `end` if there is none."""
    field = at
    while (field := data.find(b"\x04\0\0\0op=", field, end)) >= 0:
        for start in range(field - 4, max(at, field - _FARTHEST_OP) - 1, -1):
            size = int.from_bytes(data[start : start + 4], "little")
            if size < field + 8 - start - 4 or size > _LONGEST_HEADER or data[start + 3]:
                continue
            try:
                record = _record_at(data, start)
            except BROKEN:
                continue
            if record.op in ops and record.end <= end + (end if record.op == records.OP_CHUNK else 0):
                return start
        field += 1
    return end
