"""Flights of tables on NASA's cFE 7.0.0 and 7.0.1, on record: cfepy answers each step alike."""

from __future__ import annotations

import json
import lzma
from pathlib import Path
from typing import Any

import pytest

from dev.twin import tables_flight

DATA = Path(__file__).parent / "data"
ORDINARY = 250
"""Steps that every run of the tests flies; the slow ones fly all."""


def differences(version: str, count: int | None) -> list[str]:
    path = DATA / f"tables_{version.replace('.', '_')}.json.xz"
    record: dict[str, Any] = json.loads(lzma.decompress(path.read_bytes()))
    steps = record["steps"][:count]
    assert len(steps) >= ORDINARY
    answers = tables_flight.fly(version, steps)
    rows = zip(steps, answers, record["answers"], strict=False)
    return [
        f"step {number}, {step}: {ours}, NASA's: {theirs}"
        for number, (step, ours, theirs) in enumerate(rows)
        if ours != theirs
    ]


@pytest.mark.parametrize("version", ["7.0.0", "7.0.1"])
def test_first_recorded_steps_give_the_recorded_answers(version: str) -> None:
    assert differences(version, ORDINARY) == []


@pytest.mark.slow
@pytest.mark.parametrize("version", ["7.0.0", "7.0.1"])
def test_all_recorded_steps_give_the_recorded_answers(version: str) -> None:
    assert differences(version, None) == []
