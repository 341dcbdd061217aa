"""The crew for a command line."""

from __future__ import annotations

import os
from collections.abc import Callable
from pathlib import Path

import pytest

from cfepy.extra.exploration.campaign import Campaign
from cfepy.extra.exploration.search import make_search
from cfepy.extra.exploration.trial import Trial
from cfepy.extra.exploration.verdict import Verdict
from cfepy.extra.exploration.worker_pools import make_crew
from cfepy.extra.exploration.workers import Processes
from cfepy.pilot.plan import RunPlan
from cfepy.schedules.schedule import Schedule
from cfepy.status import UsageError
from tests.extra.exploration import missions


@pytest.mark.parametrize(
    ("options", "told"),
    [
        ({"jobs": 0}, "--jobs: must be 1 or more, not 0"),
        ({"longest_s": 0}, "--longest: must be greater than 0 s, not 0 s"),
        ({"jobs": 2, "cluster": "local:2"}, "--jobs: cannot be combined with --cluster"),
    ],
)
def test_invalid_combinations_of_options_are_refused(options: dict[str, int], told: str) -> None:
    with pytest.raises(UsageError) as caught:
        make_crew(10, **options)  # type: ignore[arg-type]  # the mistake
    assert str(caught.value) == told


@pytest.mark.slow
def test_worker_processes_give_the_same_verdicts_as_this_process() -> None:
    trial = Trial(RunPlan(("capture",), seconds=0.05))
    crew = make_crew(6, jobs=2)
    assert isinstance(crew, Processes)
    told: list[Verdict] = []
    search = make_search("all", None, 100, Schedule())
    Campaign(trial, search, 6, crew).run(lambda _, verdict: told.append(verdict))
    assert told == [trial.run(verdict.schedule) for verdict in told]
    assert len({verdict.schedule for verdict in told}) == 6


@pytest.mark.slow
@pytest.mark.parametrize(
    "text",
    [
        "random:3",
        *(pytest.param(text, marks=pytest.mark.slow) for text in ("pct:3:3:60:hold=1ms", "random:4:from=600ms")),
    ],
)
def test_schedule_has_one_verdict_in_any_process_and_context_and_for_any_hash_seed(text: str, tmp_path: Path) -> None:
    schedule = Schedule.parse(text)
    bank = missions.write(tmp_path, {"BANK": missions.LOST_UPDATE})
    found: list[Verdict] = []
    for tasks, hash_seed in (("thread", "2"), ("greenlet", "77")):
        trial = Trial(RunPlan((str(bank),), seconds=0.7, tasks=tasks))
        found.append(trial.run(schedule))
        crew = Processes(1, environ={**os.environ, "PYTHONHASHSEED": hash_seed})  # forks, on greenlets from=...
        Campaign(trial, Same(schedule), 2, crew).run(lambda _, verdict: found.append(verdict))
    assert len(found) == 6
    assert all(verdict == found[0] for verdict in found)
    assert found[0].trace
    assert not found[0].trouble


class Same:
    """One schedule again and again."""

    def __init__(self, schedule: Schedule) -> None:
        self.next: Callable[[], Schedule] = lambda: schedule

    def tell(self, number: int, verdict: Verdict) -> None:
        """Nothing to learn."""


def test_module_in_the_working_directory_is_not_imported_by_a_worker(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (tmp_path / "random.py").write_text("open('executed', 'w').close()\n", encoding="utf-8")
    monkeypatch.chdir(tmp_path)
    told: list[Verdict] = []
    search = make_search("all", None, 100, Schedule())
    Campaign(Trial(RunPlan(("lab",), seconds=0.01)), search, 1, Processes(1)).run(
        lambda _, verdict: told.append(verdict)
    )
    assert [verdict.failures for verdict in told] == [()]
    assert not (tmp_path / "executed").exists()
