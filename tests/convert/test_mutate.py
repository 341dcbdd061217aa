"""The check comes to an end on damaged sources, and calls nothing clean that does not compile."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from tests.convert.mutate import DAMAGES, NODES, STUB, Damaging


@pytest.mark.parametrize("kind", sorted(DAMAGES))
def test_each_kind_damages(kind: str) -> None:
    source = NODES[0].encode()
    assert any(DAMAGES[kind](random.Random(seed), source) != source for seed in range(3))


@pytest.mark.slow
def test_what_is_whole_compiles(tmp_path: Path) -> None:
    damaging = Damaging(1, tmp_path)
    outcome = damaging.check("nothing", NODES[2].encode(), [tmp_path / "stub"])
    assert (outcome.compiles, outcome.refused, outcome.problem) == (True, False, "")
    assert (tmp_path / "stub" / next(iter(STUB))).is_file()


@pytest.mark.slow
def test_damaged_files(tmp_path: Path) -> None:
    wrong = [each for each in Damaging(20261123, tmp_path).outcomes(60) if each.problem]
    assert not wrong
