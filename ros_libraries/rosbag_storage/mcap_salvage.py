"""Recovers a damaged MCAP file; see `Salvage`. Imports what the package has."""

from __future__ import annotations

import re
import zlib
from collections.abc import Generator, Iterator

from . import compression
from . import mcap_records as mcap
from .errors import ROSBagException, ROSBagFormatException
from .salvage import BROKEN, CUT_OFF, Bytes, Loss, Salvage, beginning_of

_FOOTER_BYTES = mcap.PREFIX.size + 20
_CANDIDATE = re.compile(rb"(?=[\x01-\x0f].{5}\0\0\0)", re.DOTALL)
"""What can be an opcode with a length of less than a terabyte."""
_LONGEST = 1 << 40
_IN_CHUNKS = frozenset((mcap.SCHEMA, mcap.CHANNEL, mcap.MESSAGE))
_AT_THE_TOP = frozenset((*range(mcap.HEADER, mcap.DATA_END + 1), *range(0x80, 0x100)))  # the latter are private


def _is_text(schema: mcap.McapSchema | None) -> bool:
    """Return whether there is a schema, and its definition can be read."""
    try:
        return schema is not None and schema.data.decode() is not None
    except UnicodeDecodeError:
        return False


class McapSalvage(Salvage):
    """Recovery of a damaged MCAP file; see `Salvage`."""

    def __init__(self, data: Bytes) -> None:
        super().__init__(data)
        self._schemas: dict[int, mcap.McapSchema] = {}
        self._of_summary: dict[int, mcap.RecordedChannel] = {}  # of one that no checksum vouches for

    def _messages(self) -> Iterator[mcap.RecordedMessage]:
        data, end = self.data, len(self.data)
        self._read_summary()
        at = len(mcap.MAGIC)
        if data[:at] != mcap.MAGIC:
            at = self._resync(0, "the file does not begin like an MCAP file")
        while at < end:
            if end - at == len(mcap.MAGIC) and data[at:end] == mcap.MAGIC:
                return
            try:
                op, size = self._prefix(data, at)
                start = at + mcap.PREFIX.size
                if op == mcap.CHUNK:
                    at = yield from self._chunk(at, size)
                    continue
                if start + size > end or op not in _AT_THE_TOP:
                    raise ROSBagFormatException(f"a record of the kind {op} does not fit, at byte {at:,}")
                if not self._follows(data, start + size, end, _AT_THE_TOP):
                    raise ROSBagFormatException(f"the stated length of a record does not match, at byte {at:,}")
                if op == mcap.MESSAGE:
                    yield self._message(data, at, size)
                else:
                    self._take(op, mcap.Body(data[start : start + size], start))
                at = start + size
            except ImportError:
                raise
            except BROKEN as error:
                at = self._resync(at, error)

    def _resync(self, at: int, why: object) -> int:
        found = self._next(self.data, at + 1, len(self.data), _AT_THE_TOP)
        self._lose(at, found, why)
        return found

    def _read_summary(self) -> None:
        """Read channels and numbers of messages from the end of the file, if it is present."""
        data = self.data
        end = len(data) - len(mcap.MAGIC)
        footer = end - _FOOTER_BYTES
        try:
            if data[end:] != mcap.MAGIC or self._prefix(data, footer) != (mcap.FOOTER, 20):
                return
            at = mcap.Body(data[footer + mcap.PREFIX.size : end], footer).uint64() or footer
            crc = int.from_bytes(data[end - 4 : end], "little")
            is_sound = zlib.crc32(data[at : end - 4]) == crc
            while at < footer:
                op, size = self._prefix(data, at)
                body = mcap.Body(data[at + mcap.PREFIX.size : at + mcap.PREFIX.size + size], at)
                if op == mcap.STATISTICS:
                    self.expected = mcap.statistics_of(body)
                elif op in (mcap.SCHEMA, mcap.CHANNEL):
                    self._take(op, body)
                at += mcap.PREFIX.size + size
        except BROKEN:
            crc, is_sound = -1, False
        if is_sound or crc == 0:
            self.finished = at == footer
        else:
            self.expected = None
        if not is_sound:  # data of the chunks takes precedence
            self._of_summary, self.channels, self._schemas = self.channels, {}, {}

    def _prefix(self, data: Bytes, at: int) -> tuple[int, int]:
        if at < 0 or len(data) - at < mcap.PREFIX.size:
            raise ROSBagFormatException(f"the file ends in the middle of a record, at byte {at:,}")
        op, size = mcap.PREFIX.unpack_from(data, at)
        return int(op), int(size)

    def _take(self, op: int, body: mcap.Body) -> None:
        """Process a record other than a message or a chunk."""
        if op == mcap.SCHEMA:
            number, schema = mcap.schema_of(body)
            if not _is_text(self._schemas.get(number)):  # a schema of the summary may have a damaged text
                self._schemas[number] = schema
        elif op == mcap.CHANNEL:
            channel = mcap.channel_of(body, self._schemas)
            self.channels.setdefault(channel.id, channel)
        elif op == mcap.METADATA:
            self.metadata.append((body.text(), body.texts()))
        elif op == mcap.ATTACHMENT:
            times = body.uint64(), body.uint64()
            self.attachments.append((*times, body.text(), body.text(), body.take(body.uint64())))

    def _chunk(self, at: int, size: int) -> Generator[mcap.RecordedMessage, None, int]:
        """Yield the messages of a chunk. Returns the position of the next record."""
        data, end = self.data, len(self.data)
        start = at + mcap.PREFIX.size
        chunk = mcap.chunk_of(mcap.Body(data[start : start + 64], start))
        first = start + chunk.data_at
        said = (start + size, first + chunk.stored_size)
        ends = [each for each in said if self._follows(data, each, end, _AT_THE_TOP)]
        if said[0] == said[1] <= end:
            ends = [said[0]]  # a length that occurs twice is right, and the bytes that follow may be damaged
        self.chunks[chunk.kind] += 1
        lost = len(self.losses)
        if chunk.kind == compression.NONE:
            is_whole = bool(ends) and ends[0] - first == chunk.stored_size == chunk.size
            stop = ends[0] if is_whole else -1
            wrong = is_whole and chunk.crc and zlib.crc32(data[first:stop]) != chunk.crc
            place = first
            found = yield from self._walk(data, first, stop, True, bool(wrong))
        else:
            stored = data[first : ends[0] if ends else end]
            unpacked, why = beginning_of(chunk.kind, stored)
            wrong = why != CUT_OFF and chunk.crc and zlib.crc32(unpacked) != chunk.crc
            yield from self._walk(unpacked, 0, len(unpacked), False, bool(wrong))
            found, place = (ends[0] if ends else first), at
            if why or len(self.losses) > lost or len(unpacked) != chunk.size:
                why = why or f"a chunk of {chunk.size:,} bytes is damaged"
                self.losses[lost:] = [Loss(at, len(stored), f"{why}, at byte {at:,}")]
        if len(self.losses) == lost and (said[0] != said[1] or not ends):
            self._lose(at, at, f"the stated length of a chunk does not match, at byte {at:,}")
        if wrong and len(self.losses) == lost:
            self.losses.append(Loss(place, 0, f"the stated checksum of a chunk does not match, at byte {at:,}"))
        if not ends and chunk.kind != compression.NONE:
            return self._resync(first, f"the stated length of a chunk does not match, at byte {at:,}")
        return found

    def _walk(
        self, data: Bytes, at: int, stop: int, in_file: bool, is_doubtful: bool
    ) -> Generator[mcap.RecordedMessage, None, int]:
        """Yield the messages in the records of a chunk. Returns where they end.

        Args:
            data: the bytes: of the chunk, or of the file if they are not compressed.
            at: where they begin.
            stop: where they should end; negative if that is unknown.
            in_file: the data are the file.
            is_doubtful: the checksum is wrong.
        """
        end = len(data) if stop < 0 else stop
        kinds = _AT_THE_TOP if in_file and stop < 0 else _IN_CHUNKS
        while at < end:
            try:
                op, size = self._prefix(data, at)
                start = at + mcap.PREFIX.size
                if op not in _IN_CHUNKS:
                    if stop < 0 and in_file and self._follows(data, at, end, _AT_THE_TOP):
                        break
                    raise ROSBagFormatException(f"a record of the kind {op} in a chunk, at byte {at:,}")
                if start + size > end:
                    raise ROSBagFormatException(f"a message is cut off, at byte {at:,}")
                if not self._follows(data, start + size, end, kinds):
                    raise ROSBagFormatException(f"the stated length of a message does not match, at byte {at:,}")
                if op == mcap.MESSAGE:
                    message = self._message(data, at, size)
                    self.doubtful += is_doubtful
                    yield message
                else:
                    self._take(op, mcap.Body(data[start : start + size], start))
                at = start + size
            except BROKEN as error:
                found = self._next(data, at + 1, end, kinds)
                self._lose(at, found, error)
                at = found
        return at

    def _message(self, data: Bytes, at: int, size: int) -> mcap.RecordedMessage:
        start = at + mcap.PREFIX.size
        if size < mcap.MESSAGE_HEAD.size:
            raise ROSBagException(f"a message is cut off, at byte {at:,}")
        number, sequence, time, publish_time = mcap.MESSAGE_HEAD.unpack_from(data, start)
        if number not in self.channels and number in self._of_summary:
            self.channels[number] = self._of_summary[number]
        if number not in self.channels:
            raise ROSBagException(f"the channel {number} of a message is lost, at byte {at:,}")
        content = bytes(data[start + mcap.MESSAGE_HEAD.size : start + size])
        return mcap.RecordedMessage(self.channels[number], time, content, publish_time, sequence)

    def _follows(self, data: Bytes, at: int, end: int, kinds: frozenset[int]) -> bool:
        """Return whether the file ends at a byte, or a record of some kinds begins there, possibly truncated or
        damaged.

        A record with a damaged kind is recognised by its length, at whose end another record begins. A record with a
        damaged length is recognised by its kind.
        """
        if at >= end:
            return at == end
        if end - at == len(mcap.MAGIC) and data[at:end] == mcap.MAGIC:
            return kinds is _AT_THE_TOP
        if end - at < mcap.PREFIX.size:
            return end == len(data) and self._is_cut_off(bytes(data[at:end]), kinds)
        op, size = mcap.PREFIX.unpack_from(data, at)
        if op not in kinds:
            after = at + mcap.PREFIX.size + size
            return after == end or (after < end and self._begins(data, after, end, kinds))
        if op == mcap.CHUNK:
            try:
                mcap.chunk_of(mcap.Body(data[at + mcap.PREFIX.size : at + mcap.PREFIX.size + 64], at))
            except ROSBagException:
                return False
            return True
        return bool(size < _LONGEST) or (op == mcap.MESSAGE and self._is_of_channel(data, at + mcap.PREFIX.size, end))

    def _begins(self, data: Bytes, at: int, end: int, kinds: frozenset[int]) -> bool:
        """Return whether a record of some kinds begins at a byte, and is neither cut off nor damaged."""
        return end - at >= mcap.PREFIX.size and data[at] in kinds and self._follows(data, at, end, kinds)

    @staticmethod
    def _is_cut_off(rest: bytes, kinds: frozenset[int]) -> bool:
        """Return whether the last bytes of the file are the beginning of a record of some kinds, or of its last
        eight bytes."""
        return (rest[0] in kinds and not any(rest[6:])) or (kinds is _AT_THE_TOP and mcap.MAGIC.startswith(rest))

    def _is_of_channel(self, data: Bytes, start: int, end: int) -> bool:
        """Return whether the content of a message with a damaged length names an existing channel."""
        return start + 2 <= end and int.from_bytes(data[start : start + 2], "little") in self.channels

    def _next(self, data: Bytes, at: int, end: int, kinds: frozenset[int]) -> int:
        """Return where the next record of some kinds begins that is followed by another, or `end` if there is none."""
        for match in _CANDIDATE.finditer(data, at, end):
            found = match.start()
            if not self._follows(data, found, end, kinds):
                continue
            op, size = mcap.PREFIX.unpack_from(data, found)
            after = found + mcap.PREFIX.size + size
            if op == mcap.CHUNK or (size >= 4 and after <= end and self._follows(data, after, end, kinds)):
                return found
        return end
