"""A campaign gives the same verdicts in the same order with any crew, and each schedule has exactly one."""

from __future__ import annotations

import os
import select
import signal
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from cfepy.extra.exploration.campaign import (
    AHEAD,
    Campaign,
    Crew,
    Experiment,
    Inline,
    NumberedVerdict,
    Search,
    Take,
    Tally,
    judge,
)
from cfepy.extra.exploration.results_file import ResultsFile, read_results
from cfepy.extra.exploration.verdict import Verdict
from cfepy.extra.exploration.workers import PROCESS_DIED, Processes, Worker
from cfepy.reading.resources import import_path
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from cfepy.units import NS_PER_S
from tests.extra.exploration.fake_trials import Environment, FakeTrial, Seeds

IDENTITY = {"plan": {"words": ["a"], "seed": 0}, "search": "random"}


def run(
    trial: Experiment, count: int, crew: Crew, file: ResultsFile | None = None, search: Search | None = None
) -> tuple[list[NumberedVerdict], Tally]:
    told: list[NumberedVerdict] = []
    tally = Campaign(trial, search or Seeds(), count, crew, file).run(
        lambda number, verdict: told.append((number, verdict))
    )
    return told, tally


class Backwards:
    """A crew that takes all it can and gives the verdicts in the wrong order."""

    def run(self, trial: Experiment, take: Take) -> Iterator[NumberedVerdict]:
        jobs = take(10 * AHEAD)
        yield from ((number, judge(trial, schedule)) for number, schedule in reversed(jobs))

    def close(self) -> None:
        """Nothing to end."""


@pytest.mark.parametrize(
    "crew",
    [Inline(), Backwards(), Processes(1), pytest.param(Processes(2), marks=pytest.mark.slow)],
    ids=["inline", "back", "1", "2"],
)
def test_verdicts_arrive_in_order_with_any_crew(crew: Crew) -> None:
    trial = FakeTrial(fails=(3, 40), raises=(5,))
    told, tally = run(trial, 100, crew)
    assert [number for number, _ in told] == list(range(100))
    assert all(verdict.schedule.seed == number for number, verdict in told)
    assert [number for number, verdict in told if verdict.failed] == [3, 40]
    assert "ZeroDivisionError: seed 5" in told[5][1].trouble
    assert tally == Tally(done=100, failed=2, troubled=1)


def test_progress_is_notified_of_each_schedule_and_the_end() -> None:
    heard: list[bool | None] = []

    class Heard:
        def arrived(self, failed: bool) -> None:
            heard.append(failed)

        def close(self) -> None:
            heard.append(None)

    trial = FakeTrial(fails=(1,), raises=(2,))
    Campaign(trial, Seeds(), 4, Inline(), progress=Heard()).run(lambda *_: None)
    assert heard == [False, True, True, False, None]


def test_more_schedules_than_the_lookahead_are_judged() -> None:
    told, tally = run(FakeTrial(), AHEAD + 10, Backwards())
    assert tally.done == len(told) == AHEAD + 10


@pytest.mark.parametrize(
    "crew",
    [Inline(), Backwards(), pytest.param(Processes(2), marks=pytest.mark.slow)],
    ids=["inline", "back", "2"],
)
def test_first_failure_in_order_ends_the_campaign(crew: Crew) -> None:
    trial = FakeTrial(fails=(29, 30, 31, 5000))
    told: list[int] = []

    def until_failure(number: int, verdict: Verdict) -> bool:
        told.append(number)
        return verdict.failed

    tally = Campaign(trial, Seeds(), 100_000, crew).run(until_failure)
    assert told == list(range(30))
    assert tally == Tally(done=30, failed=1)


def test_a_search_that_waits_for_verdicts() -> None:
    class Doubling:
        """Has a schedule, then two for each verdict."""

        def __init__(self) -> None:
            self.open = [Schedule("random", 0)]
            self.made = 1

        def next(self) -> str | None:
            return self.open.pop(0) if self.open else None

        def tell(self, number: int, verdict: Verdict) -> None:
            if self.made < 60:
                self.open += [Schedule("random", self.made), Schedule("random", self.made + 1)]
                self.made += 2

    for crew in (Inline(), Processes(2)):
        told, tally = run(FakeTrial(), 1000, crew, search=Doubling())
        assert [verdict.schedule.seed for _, verdict in told] == list(range(61))
        assert tally.done == 61


@pytest.mark.slow
def test_a_mission_that_cannot_fly_ends_the_campaign() -> None:
    for crew in (Inline(), Processes(2)):
        with pytest.raises(UsageError) as caught:
            run(FakeTrial(unusable=True), 10, crew)
        assert str(caught.value) == "nowhere.scr:3: words: no such mission"


@pytest.mark.slow
def test_schedule_that_always_kills_its_process_is_a_failure() -> None:
    told, tally = run(FakeTrial(exits=(4,), killed=(11,), fails=(12,)), 40, Processes(2))
    assert [number for number, _ in told] == list(range(40))
    failures = {number: verdict.failures[0] for number, verdict in told if verdict.failed}
    assert sorted(failures) == [4, 11, 12]
    assert failures[4].kind == PROCESS_DIED
    assert failures[4].text == "the process died: ended with exit status 7"
    assert failures[11].text == "the process died: killed by SIGKILL (no memory left?)"
    assert failures[12].kind == "died"
    assert tally == Tally(done=40, failed=3)


def test_schedule_is_blamed_after_two_deaths_of_its_own() -> None:
    crew = Processes(1)

    def bury(*numbers: int) -> list[int]:
        worker = Worker.__new__(Worker)
        worker.jobs, worker.ready = [(number, Schedule("random", number)) for number in numbers], True
        worker.last_words = worker.close = lambda: ""  # type: ignore[method-assign, assignment]
        crew.workers.append(worker)
        return [number for number, _ in crew._bury(worker, "killed")]

    assert [bury(1, 2, 3), bury(1, 2), bury(1, 3), bury(2)] == [[]] * 4
    assert bury(2) == [2]
    assert bury(3) == []
    assert bury(3) == [3]


@pytest.mark.slow
def test_schedule_that_kills_its_process_once_is_tried_again(tmp_path: Path) -> None:
    notes, log = tmp_path / "notes", tmp_path / "log"
    notes.mkdir()
    told, tally = run(FakeTrial(exits=(0,), killed=(20,), once=notes, log=log), 40, Processes(2))
    assert sorted(path.name for path in notes.iterdir()) == ["0", "20"]
    assert [number for number, _ in told] == list(range(40))
    assert tally == Tally(done=40)


@pytest.mark.slow
def test_schedule_that_never_ends_is_a_failure_with_its_place(tmp_path: Path) -> None:
    told, tally = run(FakeTrial(hangs=(3,)), 6, Processes(2, longest_s=0.5))
    assert [number for number, _ in told] == list(range(6))
    failure = told[3][1].failures[0]
    assert failure.text == "the process died: did not end within 0.5 s of wall time"
    assert "fake_trials.py" in failure.detail
    assert tally.failed == 1


@pytest.mark.slow
def test_killed_worker_loses_no_verdict() -> None:
    """One is killed in whatever it does, and another one when all schedules that were out then have their verdicts."""
    crew, search = Processes(2), Seeds()
    told: list[int] = []
    drawn = [100]  # schedules that must be reported before the next one is killed

    def kill_workers(number: int, verdict: Verdict) -> bool:
        told.append(number)
        if number >= drawn[-1] and len(drawn) < 4:
            os.kill(next(worker for worker in crew.workers if worker.ready).pid, signal.SIGKILL)
            drawn.append(search.given)
        return number >= drawn[-1]

    tally = Campaign(FakeTrial(), search, 1_000_000, crew).run(kill_workers)
    assert len(drawn) == 4
    assert told == list(range(drawn[-1] + 1))
    assert tally == Tally(done=drawn[-1] + 1)


def test_worker_that_does_not_start_is_reported(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("sys.executable", "/bin/false")
    with pytest.raises(UsageError, match="worker processes do not start: ended with exit status 1"):
        run(FakeTrial(), 3, Processes(1))


@pytest.mark.parametrize("hash_seed", [None, "7"])
def test_workers_have_a_hash_seed(hash_seed: str | None, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("PYTHONHASHSEED", raising=False)
    if hash_seed is not None:
        monkeypatch.setenv("PYTHONHASHSEED", hash_seed)
    told, _ = run(Environment(), 1, Processes(1))
    assert [verdict.trace for _, verdict in told] == [hash_seed or "0"]


@pytest.mark.slow
def test_workers_are_gone_after_the_campaign() -> None:
    crew = Processes(2)
    pids: set[int] = set()

    def look(number: int, verdict: Verdict) -> None:
        pids.update(worker.pid for worker in crew.workers)

    Campaign(FakeTrial(), Seeds(), 20, crew).run(look)
    assert pids
    assert not crew.workers
    for pid in pids:
        with pytest.raises(ProcessLookupError):
            os.kill(pid, 0)


@pytest.mark.parametrize("jobs", [0, pytest.param(1, marks=pytest.mark.slow)])
def test_second_run_judges_only_missing_schedules(tmp_path: Path, jobs: int) -> None:
    def crew() -> Crew:
        return Processes(jobs) if jobs else Inline()

    path, log = tmp_path / "results", tmp_path / "log"
    trial = FakeTrial(fails=(2, 15), log=log)
    first, tally = run(trial, 10, crew(), ResultsFile(path, IDENTITY))
    assert tally == Tally(done=10, failed=1)
    second, tally = run(trial, 30, crew(), ResultsFile(path, IDENTITY))
    assert tally == Tally(done=30, failed=2, resumed=10)
    assert second[:10] == first
    assert sorted(map(int, log.read_text(encoding="utf-8").split())) == list(range(30))
    third, tally = run(trial, 30, crew(), ResultsFile(path, IDENTITY))
    assert (third, tally) == (second, Tally(done=30, failed=2, resumed=30))
    assert sorted(number for number, _ in read_results(path)[1]) == list(range(30))


def test_more_schedules_than_the_lookahead_are_resumed(tmp_path: Path) -> None:
    with_file = ResultsFile(tmp_path / "results", IDENTITY)
    for number in range(AHEAD + 50):
        with_file.append(number, Verdict(Schedule("random", number)).to_dict())
    with_file.close()
    told, tally = run(FakeTrial(), AHEAD + 60, Inline(), ResultsFile(tmp_path / "results", IDENTITY))
    assert [number for number, _ in told] == list(range(AHEAD + 60))
    assert tally.resumed == AHEAD + 50


@pytest.mark.slow
def test_ctrl_c_keeps_the_verdicts_so_far(tmp_path: Path) -> None:
    path = tmp_path / "results"

    def interrupt(number: int, verdict: Verdict) -> None:
        if number == 5:
            raise KeyboardInterrupt

    tally = Campaign(FakeTrial(), Seeds(), 50, Processes(2), ResultsFile(path, IDENTITY)).run(interrupt)
    assert tally == Tally(done=6, interrupted=True)
    assert {number for number, _ in read_results(path)[1]} >= set(range(6))
    told, tally = run(FakeTrial(), 50, Processes(2), ResultsFile(path, IDENTITY))
    assert [number for number, _ in told] == list(range(50))


PARENT = """
import sys
from cfepy.extra.exploration.campaign import Campaign
from cfepy.extra.exploration.workers import Processes
from tests.extra.exploration.fake_trials import Environment, FakeTrial, Seeds

crew = Processes(1)
def tell(number, verdict):
    print(*(worker.pid for worker in crew.workers), flush=True)
Campaign(FakeTrial(hangs=(1,)), Seeds(), 3, crew).run(tell)
"""


def test_workers_end_with_their_parent() -> None:
    """Also when it is killed, and they are in the middle of a schedule that does not end."""
    environment = {**os.environ, "PYTHONPATH": import_path()}
    process = subprocess.Popen([sys.executable, "-c", PARENT], stdout=subprocess.PIPE, env=environment)
    with process:
        assert process.stdout is not None
        worker = int(process.stdout.readline())
        ended = os.pidfd_open(worker)
        try:
            process.kill()
            process.wait()
            assert select.select([ended], [], [], 30)[0]
        finally:
            os.close(ended)


def test_time_in_which_other_programs_had_the_cpu_does_not_count() -> None:
    starved: Any = SimpleNamespace(ready=True, busy_ns=3 * NS_PER_S, own_ns=NS_PER_S)
    sleeping: Any = SimpleNamespace(ready=True, busy_ns=3 * NS_PER_S, own_ns=3 * NS_PER_S)
    crew = Processes(1, longest_s=2.0)
    assert (crew._left_ns(starved), crew._left_ns(sleeping)) == (NS_PER_S, -NS_PER_S)
