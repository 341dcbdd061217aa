"""The corpus of a campaign that was guided by coverage: the schedules with which a later one may begin.

A campaign needs no corpus file to go on: what it knows is in the verdicts of its results file. When it ends, the
schedules that together cover all that was covered are written behind these as moves, which mean the same after an edit
of the mission. So a campaign on another version of the mission can begin with them.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from pathlib import Path

from cfepy.exploration.greybox import Member
from cfepy.exploration.moves import MoveNotingPolicy
from cfepy.exploration.results_file import add_schedules, read_failures, read_results, read_schedules
from cfepy.exploration.trial import Trial
from cfepy.exploration.verdict import Verdict
from cfepy.rtos import Policy, Schedule

MOST = 100  # schedules that are written


def distilled(corpus: Iterable[Member]) -> list[Member]:
    """Few members that together cover what all cover: in each turn the one that adds the most, of equals the first."""
    found: list[Member] = []
    left = [(member, {each[:2] for each in member.verdict.covered}) for member in corpus]
    while left and len(found) < MOST:
        member, covered = max(left, key=lambda each: len(each[1]))
        if not covered:
            break
        found.append(member)
        left = [(other, things - covered) for other, things in left if other is not member]
    return found


def as_moves(trial: Trial, schedule: Schedule) -> Schedule:
    """The schedule of moves that gives the same run; the run is flown once more.

    Args:
        trial: what is flown.
        schedule: any.
    """
    noted = MoveNotingPolicy(schedule.policy() or Policy(*schedule.settings))
    trial.fly(schedule, policy=noted)
    return schedule.by_moves(each.move for each in noted.made)


def keep_corpus(path: str | Path, trial: Trial, corpus: Iterable[Member]) -> None:
    """Write a corpus to the results file of its campaign, which is whole.

    Args:
        path: of the file.
        trial: what is flown.
        corpus: all of its members.

    Raises:
        UsageError: it cannot be written.
    """
    bare = replace(trial, usual=None, keep_widths=False, waits=None)
    known = set(read_schedules(path))
    found = (as_moves(bare, member.verdict.schedule) for member in distilled(corpus))
    add_schedules(path, (schedule for schedule in found if schedule not in known))


def read_corpus(path: str | Path, options: Schedule) -> tuple[Schedule, ...]:
    """The schedules of a results file with which another campaign may begin, each once.

    These are those of its failures, and of its corpus; where the campaign was broken off, all that it covered something
    new with.

    Args:
        path: of the file.
        options: a schedule whose options all get.

    Raises:
        UsageError: it is no results file.
    """
    found = [schedule for _, schedule in read_failures(path).values()]
    found += read_schedules(path) or _covering(path)
    return tuple(dict.fromkeys(_with_options(each, options) for each in found))


def _covering(path: str | Path) -> list[Schedule]:
    """The schedules of verdicts that have something which none before them has."""
    found: list[Schedule] = []
    seen: set[tuple[str, int]] = set()
    _, verdicts = read_results(path)
    for _, plain in sorted(verdicts, key=lambda each: each[0]):
        verdict = Verdict.from_dict(plain)
        new = {each[:2] for each in verdict.covered} - seen
        if new:
            found.append(verdict.schedule)
            seen |= new
    return found


def _with_options(schedule: Schedule, options: Schedule) -> Schedule:
    own = ("kind", "seed", "depth", "steps", "deviations", "moves", "aims")
    return replace(options, **{name: getattr(schedule, name) for name in own})
