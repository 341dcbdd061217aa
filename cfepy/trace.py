"""The trace of a run: a record of every event in order, and a digest that is equal if two runs are the same.

A record is a bytes object. Its first byte is its kind. A packet is recorded unchanged, because its first byte is below
0x20. Appending a record costs about ten nanoseconds, because records are kept by reference and hashed in batches.
"""

from __future__ import annotations

import struct
from collections.abc import Callable
from hashlib import blake2b
from typing import SupportsIndex

TIME = b"T"  # followed by the virtual time in ns, 8 bytes little-endian
DISPATCH = b"S"  # followed by the task, 2 bytes
WAKE = b"W"  # followed by the task
EXIT = b"X"  # followed by the task that runs next
PUT = b"P"  # followed by the queue
GET = b"G"  # followed by the queue
RECEIVE = b"R"  # followed by the pipe
DROP = b"D"  # followed by the pipe
NOTE = b"N"  # followed by a text, UTF-8
UNSENT = b"U"  # followed by a topic, a zero byte and a message that the bus does not carry; a packet has no topic

CALLED = b"C"  # followed by a place in C, a zero byte and the numbers of a call there; only in runs that are compared
ONLY_COMPARED = (CALLED,)

BATCH = 4096
LARGE = 65536
"""Size in bytes above which a record is not kept until its batch is full."""

pack_time: Callable[[bytes, int], bytes] = struct.Struct("<cq").pack
unpack_time = struct.Struct("<xq").unpack


def mark(kind: bytes, number: int) -> bytes:
    """Return the record for an event of task, queue or pipe `number`."""
    return kind + (number & 0xFFFF).to_bytes(2, "little")


class TimedRecords(list[bytes]):
    """A list of trace records that also keeps the time of each record, for viewers.

    The records themselves hold only the steps of the clock. A task that uses the CPU is already later than the last
    step.

    Attributes:
        times: virtual time of each record in ns.
        now: returns the virtual time in ns.
    """

    def __init__(self) -> None:
        super().__init__()
        self.times: list[int] = []
        self.now: Callable[[], int] = lambda: 0

    def append(self, record: bytes) -> None:
        self.add(record, self.now())

    def add(self, record: bytes, time_ns: int) -> None:
        """Append a record that was made at `time_ns`."""
        self.times.append(time_ns)
        super().append(record)

    def pop(self, index: SupportsIndex = -1) -> bytes:
        self.times.pop(index)
        return super().pop(index)

    def clear(self) -> None:
        self.times.clear()
        super().clear()


class Trace:
    """Collects the records of a run. `digest()` is 128 bits of BLAKE2b over all of them.

    Args:
        sink: called with each batch of records, in order, before the batch is dropped (a trace file, a detector).
        records: the list in which they are collected; None makes a plain list.
    """

    __slots__ = ("_hash", "_sink", "append", "records")

    def __init__(self, sink: Callable[[list[bytes]], None] | None = None, records: TimedRecords | None = None) -> None:
        self.records: list[bytes] = [] if records is None else records
        self.append = self.records.append
        self._hash = blake2b(digest_size=16)
        self._sink = sink

    def take_times(self, now: Callable[[], int]) -> None:
        """Set the clock, in ns, for records that keep their times (`TimedRecords`)."""
        if isinstance(self.records, TimedRecords):
            self.records.now = now

    def also(self, sink: Callable[[list[bytes]], None]) -> None:
        """Add a second sink, which gets each batch of records after the present one."""
        first = self._sink

        def both(records: list[bytes]) -> None:
            if first is not None:
                first(records)
            sink(records)

        self._sink = both

    @property
    def hashed(self) -> str:
        """The digest of all records hashed so far; within a sink it includes the sink's batch."""
        return self._hash.hexdigest()

    def flush(self) -> None:
        """Hash the collected records and drop them."""
        records = self.records
        if records and len(records[-1]) > LARGE:  # do not copy the large record
            self._hash.update(b"".join(records[:-1]))
            self._hash.update(records[-1])
        else:
            self._hash.update(b"".join(records))
        if self._sink is not None:
            self._sink(self.records)
        self.records.clear()

    def drop_empty(self) -> None:
        """Remove an empty record at the end, if there is one."""
        if self.records and not self.records[-1]:
            self.records.pop()

    def note(self, text: str) -> None:
        """Record a text, for instance a line of the console."""
        self.append(NOTE + text.encode("utf-8", "backslashreplace"))

    def digest(self) -> str:
        """Return the digest of the run so far, as 32 hexadecimal digits."""
        self.flush()
        return self._hash.hexdigest()
