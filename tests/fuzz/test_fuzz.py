"""A few damaged inputs of each kind; `python -m dev.fuzz` runs many."""

from __future__ import annotations

from pathlib import Path

import pytest

from dev.fuzz.kinds import KINDS
from dev.fuzz.runs import failures

USUAL, MORE = 15, 12
SLOW = {
    "mission": 3,
    "table": 5,
    "table-yaml": 3,
    "launch": 10,
    "service-definition": 5,
    "rostest": 5,
    "manifest": 5,
    "python-source": 8,
    "cpp-source": 15,
}
"""Kinds of which a case takes long, and how many of them are done here."""


@pytest.mark.parametrize("name", KINDS)
def test_damaged_inputs_are_read_or_refused(name: str, tmp_path: Path) -> None:
    assert [each.what for each in failures(name, SLOW.get(name, USUAL), 1, tmp_path)] == []


@pytest.mark.slow
@pytest.mark.parametrize("name", KINDS)
def test_more_damaged_inputs_are_read_or_refused(name: str, tmp_path: Path) -> None:
    assert [each.what for each in failures(name, MORE * SLOW.get(name, USUAL), 2, tmp_path)] == []


def test_fuzzing_has_at_least_20_kinds() -> None:
    assert len(KINDS) >= 20
