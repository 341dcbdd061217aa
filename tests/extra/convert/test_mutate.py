"""The check terminates on damaged sources, and calls no source clean that does not compile."""

from __future__ import annotations

import random
from pathlib import Path

import pytest

from cfepy.extra.convert.node_check.compiler import Compiled, Compiler
from dev.convert.mutate import DAMAGES, NODES, OWN, STUB, Damaging


@pytest.mark.parametrize("kind", sorted(DAMAGES))
def test_each_kind_of_damage_changes_the_source(kind: str) -> None:
    source = NODES[0].encode()
    assert any(DAMAGES[kind](random.Random(seed), source) != source for seed in range(3))


@pytest.mark.slow
def test_undamaged_sources_compile(tmp_path: Path) -> None:
    damaging = Damaging(1, tmp_path)
    assert (tmp_path / "stub" / next(iter(STUB))).is_file()
    assert damaging.check("nothing", NODES[2].encode(), False) == ("nothing", False, False, "")
    counted = (OWN / "nodes/counted/src/counted.cpp").read_bytes()
    assert damaging.check("nothing", counted, True)[2:] == (False, "")


@pytest.mark.slow
def test_clean_source_that_does_not_compile_is_reported(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(Compiler, "compile", lambda self, source, scratch, while_waiting: Compiled(True, []))
    outcome = Damaging(1, tmp_path).check("nothing", NODES[2].encode() + b"int more = none;", False)
    assert outcome.problem == "clean, but it does not compile"


@pytest.mark.slow
def test_damaged_files(tmp_path: Path) -> None:
    wrong = [each for each in Damaging(20261123, tmp_path).outcomes(60) if each.problem]
    assert not wrong
