"""The failures of a results file, flown again in the current mission: some are gone, and some are still there.

Each is flown under the shortest schedule that the campaign found for it. Two failures are the same when their texts
differ only in numbers, because an edit moves lines.
"""

from __future__ import annotations

import contextlib
import re
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import Any

from cfepy.extra.exploration.campaign import Job
from cfepy.extra.exploration.exploration import beside_fifo
from cfepy.extra.exploration.results_file import read_failures, read_results
from cfepy.extra.exploration.trial import Trial
from cfepy.extra.exploration.verdict import Failure, Verdict
from cfepy.extra.exploration.worker_pools import make_crew
from cfepy.extra.exploration.workers import LONGEST_S
from cfepy.pilot import RunPlan
from cfepy.rtos import Policy
from cfepy.schedules import Schedule
from cfepy.status import UsageError

STILL_THERE, GONE, NOT_POSSIBLE = "still there", "gone", "schedule no longer applies"
_DIGITS = re.compile(r"\d+")


@dataclass(frozen=True, slots=True)
class ReplayedFailure:
    """A failure that was flown again.

    Attributes:
        title: its title in the results file.
        group: its group there.
        verdict: on the current mission, under the schedule that showed the failure.
        same: the failure if it is still there.
        trial: the trial that was flown.
    """

    title: str
    group: str
    verdict: Verdict
    same: Failure | None
    trial: Trial

    @property
    def state(self) -> str:
        """STILL_THERE, GONE, or NOT_POSSIBLE: it is not there, but not all moves of its schedule were possible."""
        if self.same is not None:
            return STILL_THERE
        return NOT_POSSIBLE if self.verdict.missed else GONE

    @property
    def others(self) -> tuple[str, ...]:
        """Titles of the other failures under the schedule."""
        return tuple(each.title for each in self.verdict.failures if each is not self.same)

    @property
    def command(self) -> str:
        """The command that flies it."""
        return self.trial.command(self.verdict.schedule)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data."""
        found = {"title": self.title, "state": self.state, "schedule": self.verdict.schedule.text()}
        return found | {"command": self.command, "not_possible": list(self.verdict.missed), "others": list(self.others)}


def replay_all(
    path: str, word: str | None = None, jobs: int | None = None, longest_s: float = LONGEST_S
) -> Iterator[ReplayedFailure]:
    """Fly each distinct failure of a results file again, in the order in which they were found.

    Args:
        path: of the file.
        word: another mission than the file's; None for the file's mission.
        jobs: processes; None for one on each CPU.
        longest_s: wall time in s that a flight may take.

    Raises:
        UsageError: the file is not a results file, or the mission cannot be flown.
    """
    plan, search = _campaign(path)
    if word is not None:
        plan = replace(plan, words=(word, *plan.words[1:]))
    failures = list(read_failures(path).items())
    if not failures:
        return
    bare = Trial(plan, str(search.get("events", "error")))
    options = Schedule("at")
    first = bare.fly(options, policy=options.policy() or Policy())
    trial = beside_fifo(bare, first, None if search.get("no_stuck") else options)
    jobs_left: list[Job] = [(number, schedule) for number, (_, (_, schedule)) in enumerate(failures)]

    def take(limit: int) -> list[Job]:
        taken = jobs_left[:limit]
        del jobs_left[:limit]
        return taken

    crew = make_crew(len(failures), jobs, longest_s=longest_s)
    with contextlib.closing(crew), contextlib.closing(crew.run(trial, take)) as verdicts:
        found = dict(verdicts)
    for number, (group, (title, _)) in enumerate(failures):
        yield ReplayedFailure(title, group, found[number], _same(found[number], group), trial)


def _campaign(path: str) -> tuple[RunPlan, dict[str, Any]]:
    """Return the run of a results file, and its search options."""
    campaign, _ = read_results(path)
    search = campaign.get("search")
    try:
        return RunPlan.from_dict(campaign["plan"]), search if isinstance(search, dict) else {}
    except (KeyError, TypeError, ValueError, AttributeError):
        raise UsageError("does not name its mission; explore the mission again", file=path, line=1) from None


def _same(verdict: Verdict, group: str) -> Failure | None:
    wanted = _DIGITS.sub("#", group)
    return next((each for each in verdict.failures if _DIGITS.sub("#", each.group) == wanted), None)
