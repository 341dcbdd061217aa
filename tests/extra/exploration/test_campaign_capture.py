"""Thousands of schedules of the capture mission: no error of cfepy, and no leaked memory.

The mission needs 0.6 s of virtual time to boot, so 0.2 s end during the core applications' start, and 0.8 s end 0.2 s
after all nodes are up. There are fewer of the latter, because each takes some twenty times as long. All 100,000 take
11 to 12 minutes: `cfepy explore capture --for 0.2 --seeds 100000 --results FILE`.
"""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.exploration.campaign import Campaign
from cfepy.extra.exploration.results_file import ResultsFile, read_results
from cfepy.extra.exploration.search import make_search
from cfepy.extra.exploration.trial import Trial
from cfepy.extra.exploration.verdict import Verdict
from cfepy.extra.exploration.worker_pools import make_crew
from cfepy.extra.exploration.workers import Processes, usable_cpus
from cfepy.pilot.plan import RunPlan
from cfepy.schedules.schedule import Schedule

SETTLED = 200  # schedules after which everything that is made once has been made
SLACK_KB = 24 * 1024  # varying garbage of a batch of missions


def resident_kb(pid: int | str) -> int:
    """Memory of a process."""
    lines = Path(f"/proc/{pid}/status").read_text(encoding="utf-8").splitlines()
    return next(int(line.split()[1]) for line in lines if line.startswith("VmRSS:"))


@pytest.mark.slow
@pytest.mark.parametrize(("seconds", "count"), [(0.2, 3_000), (0.8, 300)])
def test_many_schedules_of_capture(tmp_path: Path, seconds: float, count: int) -> None:
    crew = make_crew(count)
    assert isinstance(crew, Processes)
    trial = Trial(RunPlan(("capture",), seconds=seconds))
    search = make_search("all", None, trial.run(Schedule("random", 0)).decisions, Schedule())
    settled: dict[int | str, int] = {}
    grown: dict[int | str, int] = {}

    def look(number: int, verdict: Verdict) -> None:
        assert not verdict.trouble
        processes: list[int | str] = ["self", *(worker.pid for worker in crew.workers)]
        if number == SETTLED:
            settled.update({process: resident_kb(process) for process in processes})
        if number == count - 1:
            grown.update({process: resident_kb(process) - settled[process] for process in processes})

    path = tmp_path / "results"
    tally = Campaign(trial, search, count, crew, ResultsFile(path, {"mission": "capture"})).run(look)
    assert (tally.done, tally.troubled) == (count, 0)
    assert len(grown) == usable_cpus() + 1  # none of the workers had to be replaced
    assert max(grown.values()) < SLACK_KB, grown
    assert sorted(number for number, _ in read_results(path)[1]) == list(range(count))
