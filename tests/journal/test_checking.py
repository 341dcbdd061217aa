"""A replay's deviation is reported at the first checkpoint that does not agree, in whatever portions records arrive."""

from __future__ import annotations

from collections.abc import Sequence
from hashlib import blake2b
from types import SimpleNamespace
from typing import Any, cast

import pytest

from cfepy.journal.journal import Checkpoint
from cfepy.journal.replay import Checker
from cfepy.trace import CALLED, UNSENT, TimedRecords, Trace

RECORDS = [bytes([number + 1]) * 5 for number in range(12)]


def checkpoint(count: int) -> Checkpoint:
    return Checkpoint(count * 10, count, blake2b(b"".join(RECORDS[:count]), digest_size=16).hexdigest())


def checked(records: Sequence[bytes], batches: Sequence[int]) -> Checker:
    """Return a checker with checkpoints after 3, 6, 9 and 12 records that got these, cut into batches."""

    def describe(records: TimedRecords) -> list[str]:
        return [f"{record[0]} at {time}" for record, time in zip(records, records.times, strict=True)]

    checker = Checker([checkpoint(count) for count in (3, 6, 9, 12)], None, describe)
    shown, clock = TimedRecords(), iter(range(len(records)))
    shown.now, trace = lambda: next(clock), Trace(records=shown)
    checker.begin(cast(Any, SimpleNamespace(trace=trace)))
    left = list(records)
    for size in (*batches, len(left)):
        for record in left[:size]:
            trace.append(record)
        del left[:size]
        trace.flush()
    return checker


BATCHES = pytest.mark.parametrize("batches", [(), (3, 3, 3), (1,) * 11, (4, 5), (10,)])


@BATCHES
def test_equal_records_agree_to_the_last_checkpoint(batches: tuple[int, ...]) -> None:
    checker = checked(RECORDS, batches)
    assert checker.difference is None
    assert checker.agreed == checkpoint(12)


@BATCHES
@pytest.mark.parametrize("wrong", range(12))
def test_different_record_is_reported_between_its_checkpoints(wrong: int, batches: tuple[int, ...]) -> None:
    checker = checked([*RECORDS[:wrong], b"\xff", *RECORDS[wrong + 1 :]], batches)
    least = wrong // 3 * 3
    assert checker.difference is not None
    assert checker.difference.after.records == least
    assert checker.difference.before == checkpoint(least + 3)
    assert f"255 at {wrong}" in checker.difference.lines
    assert len(checker.difference.lines) == 3


def test_checker_skips_records_of_calls_in_c() -> None:
    assert checked([RECORDS[0], CALLED + b"a.c:1\0", b"", *RECORDS[1:]], ()).agreed == checkpoint(12)


def test_checker_compares_messages_without_a_subscriber() -> None:
    assert checked([RECORDS[0], UNSENT + b"/t\0x", *RECORDS[1:]], ()).agreed.records < 12
