"""Comparing streams of trace records, describing one of them, and finding probable lines of source."""

from __future__ import annotations

import io
from collections.abc import Sequence
from pathlib import Path

import pytest
from hypothesis import given
from hypothesis import strategies as st

from cfepy.pilot.determinism import Parting, RecordReader, RecordWriter, RunEndedError, first_parting
from cfepy.pilot.determinism_look import Look, LookingTrace, suspects

records = st.lists(st.binary(max_size=4), max_size=12)


def stream(batches: Sequence[Sequence[bytes]], facts: dict[str, int] | None = None) -> RecordReader:
    file = io.BytesIO()
    writer = RecordWriter(file)
    for batch in batches:
        writer.write(batch)
    if facts is not None:
        writer.end(facts)
    file.seek(0)
    return RecordReader(file)


@given(st.lists(records, max_size=4), st.lists(records, max_size=4), records)
def test_first_difference_of_streams_equals_that_in_the_lists(
    one: list[list[bytes]], other: list[list[bytes]], common: list[bytes]
) -> None:
    flat = [[record for batch in (common, *batches) for record in batch if record] for batches in (one, other)]
    expected = next((i for i, (a, b) in enumerate(zip(*flat, strict=False)) if a != b), min(map(len, flat)))
    found, agreed = first_parting([stream([common, *one], {}), stream([common, *other], {})])
    assert agreed == expected
    assert found == (None if flat[0] == flat[1] else Parting(1, expected))


def test_earliest_difference_of_several_runs_is_found() -> None:
    runs = [stream([[b"a", b"b", b"c"]], {"n": 3}) for _ in range(2)]
    runs += [stream([[b"a", b"b"], [b"x"]], {}), stream([[b"a"], [b"x"]], {})]
    assert first_parting(runs) == (Parting(3, 1), 1)


def test_end_of_a_run_is_known_or_missing() -> None:
    runs = [stream([[b"a"]], {"n": 1}), stream([[b"a"]], {"n": 2})]
    assert first_parting(runs) == (None, 1)
    assert [run.facts for run in runs] == [{"n": 1}, {"n": 2}]
    with pytest.raises(RunEndedError):
        first_parting([stream([[b"a"]], {}), stream([[b"a"]])])


def test_record_has_its_stack_and_records_around_it() -> None:
    seen: list[Look] = []
    trace = LookingTrace(3, lambda records: [record.decode() for record in records], seen.append)
    for record in (b"a", b"", b"b"):
        trace.append(record)
    trace.flush()
    for record in (b"c", b"", b"d", b"e"):
        trace.append(record)
    (look,) = seen
    assert look.record == b"d"
    assert look.lines == ("a", "b", "c", "d")
    assert look.stack[-1].source == "trace.append(record)"
    assert look.stack[-1].file == __file__
    assert look.culprit == look.stack[-1]
    assert Look.from_dict(look.to_dict()) == look
    assert LookingTrace(9, lambda records: [], seen.append).look(b"").stack == ()


def test_suspicious_lines(tmp_path: Path) -> None:
    file = tmp_path / "node.py"
    file.write_text(
        "names: set = {'a', 'b'}\n"
        "class Node:\n"
        "    def __init__(self):\n"
        "        self.seen = set()\n"
        "        self.other = {n: 1 for n in names}\n"
        "    def go(self):\n"
        "        if 'a' in self.seen: self.seen.pop()\n"
        "        for name in sorted(self.seen): print(name, len(self.seen))\n"
        "        for name in self.seen - {'c'}: print(name)\n"
        "        return ','.join(names), [x for x in self.other], id(self), self.id(3), hash('a')\n",
        encoding="utf-8",
    )
    found = [(each.line, each.why) for each in suspects(str(file))]
    assert found == [
        (5, "goes through a set"),
        (7, "takes any element of a set"),
        (9, "goes through a set"),
        (10, "goes through a set"),
        (10, "uses an address"),
        (10, "uses the hash of a text, which follows PYTHONHASHSEED"),
    ]
    file.write_text(
        "import gc, numpy as np, sqlite3\n"
        "from numpy import datetime64 as date\n"
        "from weakref import WeakSet\n"
        "import os.path\n"
        "kept = WeakSet()\n"
        "base = sqlite3.connect('x'); here = np.empty(3), date('now'), date('2026-01-01'), gc.get_count()\n"
        "there = np.zeros(3), os.path.empty(3), kept.connect('x')\n"
        "first, last = sorted(there, key=hash), max(there, key=id)\n",
        encoding="utf-8",
    )
    assert [(each.line, each.why) for each in suspects(str(file))] == [
        (5, "is a set that is ordered by addresses"),
        (6, "asks the clock of this computer"),
        (6, "calls a C library, which uses the clock and random numbers of this computer"),
        (6, "counts objects of the whole process"),
        (6, "returns uninitialized memory"),
        (8, "sorts by an address"),
        (8, "sorts by the hash of a text, which follows PYTHONHASHSEED"),
    ]
    file.write_text("this is = no program", encoding="utf-8")
    assert suspects(str(file)) == suspects(str(tmp_path / "none.py")) == []
