"""Every scenario with a public node meets its expectations."""

from __future__ import annotations

from pathlib import Path

import pytest

from dev.corpus.flight import Flight
from dev.corpus.scenarios import read_corpus
from dev.corpus.sources import Sources
from dev.corpus.verdict import judge


@pytest.mark.corpus
def test_public_node(scenario_id: str, sources_folder: Path, tmp_path: Path) -> None:
    scenario = read_corpus().scenarios[scenario_id]
    sources = Sources(sources_folder)
    assert sources.missing(scenario) == ""
    verdict = judge(scenario, Flight(scenario, sources, tmp_path).run())
    assert verdict.passed, verdict.reason
