"""Comparison of the traces of several runs of one mission while they are made, to find the first difference.

A compared run writes its records to a pipe as frames. The comparison reads one frame at a time from each run. So its
memory does not grow with the runs, and a faster run waits for the others.
"""

from __future__ import annotations

import json
import struct
from array import array
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import accumulate, pairwise
from typing import Any, BinaryIO

from cfepy.rtos import Kernel
from cfepy.trace import CALLED, ONLY_COMPARED, Trace

# number of records, and bytes that follow; with 0 records the bytes are the end of the stream
_head = struct.Struct("<II")
_LENGTH = "I"


class ComparedTrace(Trace):
    """A trace with additional records for comparison.

    Its digest leaves them out, so it is the same as the digest of a trace without them.
    """

    __slots__ = ()

    def flush(self) -> None:
        self._hash.update(b"".join(record for record in self.records if record[:1] not in ONLY_COMPARED))
        if self._sink is not None:
            self._sink(self.records)
        self.records.clear()


def hear_calls(kernel: Kernel, trace: Trace) -> None:
    """Record the calls of compiled applications too, because a different call shows that code has seen different data.

    Calls of code without debug data are left out, such as those of libgcov, whose counts continue over runs.

    Args:
        kernel: the kernel of the processor.
        trace: the trace to record in.
    """

    def heard(place: str, arguments: tuple[object, ...]) -> None:
        numbers = " ".join(str(each) for each in arguments if isinstance(each, int))
        trace.append(CALLED + f"{place}\0{numbers}".encode())

    kernel.frames_wanted = True
    kernel.call_heard = heard


class RunEndedError(Exception):
    """Exception for a compared run that ended without an end frame."""


class RecordWriter:
    """Writes records as frames.

    Args:
        file: a pipe.
    """

    def __init__(self, file: BinaryIO) -> None:
        self._file = file

    def write(self, records: Sequence[bytes]) -> None:
        """Write records without the empty ones, which the host leaves for a moment."""
        records = [record for record in records if record]
        if records:
            lengths = array(_LENGTH, map(len, records)).tobytes()
            self._write(len(records), lengths + b"".join(records))

    def end(self, facts: Mapping[str, Any]) -> None:
        """Write the end of the run, with facts about it."""
        self._write(0, json.dumps(facts).encode())

    def _write(self, count: int, body: bytes) -> None:
        self._file.write(_head.pack(count, len(body)) + body)
        self._file.flush()


@dataclass(slots=True)
class RecordReader:
    """Reads the output of a `RecordWriter`.

    Attributes:
        file: the other end of the pipe.
        pending: records that were read but not compared yet.
        facts: facts about the end of the run; None before.
    """

    file: BinaryIO
    pending: list[bytes] = field(default_factory=list)
    facts: dict[str, Any] | None = None

    def fill(self) -> None:
        """Read more records if none is pending, unless the stream has ended.

        Raises:
            RunEndedError: if the pipe was closed in the middle.
        """
        if self.pending or self.facts is not None:
            return
        count, size = _head.unpack(self._exactly(_head.size))
        body = self._exactly(size)
        if count:
            self.pending = _split(body, count)
        else:
            self.facts = json.loads(body)

    def _exactly(self, size: int) -> bytes:
        data = self.file.read(size)
        if len(data) < size:
            raise RunEndedError
        return data


def _split(body: bytes, count: int) -> list[bytes]:
    start = count * array(_LENGTH).itemsize
    ends = accumulate(array(_LENGTH, body[:start]), initial=start)
    return [body[begin:end] for begin, end in pairwise(ends)]


@dataclass(frozen=True, slots=True)
class Parting:
    """The first difference between a run and the first run.

    Attributes:
        run: number of the run, from 1.
        index: number of the first different record, from 0.
    """

    run: int
    index: int


def first_parting(runs: Sequence[RecordReader]) -> tuple[Parting | None, int]:
    """Compare runs with the first one, to their end or to the first difference, with which `pending` begins then.

    Args:
        runs: two or more.

    Returns:
        The earliest difference or None, and the number of equal records.

    Raises:
        RunEndedError: if a run ended in the middle.
    """
    agreed = 0
    while True:
        for run in runs:
            run.fill()
        common = min(len(run.pending) for run in runs)
        if not common:
            longer = [number for number, run in enumerate(runs) if bool(run.pending) != bool(runs[0].pending)]
            return (Parting(longer[0], agreed) if longer else None), agreed
        ahead = [run.pending[:common] for run in runs]
        found = [Parting(i, agreed + _prefix(ahead[0], other)) for i, other in enumerate(ahead) if other != ahead[0]]
        if found:
            earliest = min(found, key=lambda parting: parting.index)
            for run in runs:
                del run.pending[: earliest.index - agreed]
            return earliest, earliest.index
        for run in runs:
            del run.pending[:common]
        agreed += common


def _prefix(one: Sequence[bytes], other: Sequence[bytes]) -> int:
    """Return the number of equal records at the start, if at least one differs."""
    return next(at for at, (mine, theirs) in enumerate(zip(one, other, strict=True)) if mine != theirs)
