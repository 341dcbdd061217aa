"""A journal's kind of tasks, on a computer where it is not installed."""

from __future__ import annotations

import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import pytest

from cfepy.cli.main import main
from cfepy.journal import read_journal, record, replay
from tests.journal.replays import plan_for


def test_run_on_greenlets_is_replayed_on_threads_when_greenlet_is_missing(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    journal = tmp_path / "run.cfepy"
    flown = record(plan_for("lab", 0.1, tasks="greenlet"), journal)
    monkeypatch.setitem(sys.modules, "greenlet", None)
    again = replay(read_journal(journal))
    assert again.verdict.same
    assert (again.flown.mission.tasks, again.flown.trace) == ("thread", flown.trace)
    assert main(["replay", str(journal), "--no-console"]) == 0
    assert "greenlet is not installed: replayed on threads" in capsys.readouterr().err
    assert main(["replay", str(journal), "--quiet", "--tasks", "greenlet"]) == 2
    assert "pip install 'cfepy[fast]'" in capsys.readouterr().err


def test_run_on_automatic_threads_is_the_same_on_greenlets(tmp_path: Path) -> None:
    """Some runs need threads, such as one in a separate thread or under coverage. The reason makes no difference."""
    with ThreadPoolExecutor(1) as pool:
        flown = pool.submit(record, plan_for("lab", 0.1), tmp_path / "run.cfepy").result()
    assert flown.results.why_tasks
    again = replay(read_journal(tmp_path / "run.cfepy"))
    assert not again.flown.results.why_tasks
    assert again.verdict.same
