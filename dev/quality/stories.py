"""The reported cause of each planted bug, under a schedule of few preemptions that shows it.

`stories.txt` has the sentences after review; `python -m dev.quality stories` rewrites it.
"""

from __future__ import annotations

from pathlib import Path
from typing import NamedTuple

from cfepy.extra.exploration.made_moves import MoveNotingPolicy
from cfepy.extra.exploration.timeline import Story as Told
from cfepy.extra.exploration.timeline import story_of
from cfepy.rtos import Policy
from cfepy.schedules import Schedule
from dev.quality.bugs import BUGS, Bug, by_name, reference_trial
from dev.quality.measure import simplest
from dev.quality.report import load, shown_by
from dev.quality.shrinking import shrunk

STORIES = Path(__file__).with_name("stories.txt")
NOTHING = "-"


class Story(NamedTuple):
    """The reported cause of a bug: the schedule, and the sentence; empty if there is none."""

    schedule: str
    cause: str


def read() -> dict[str, Story]:
    """Return the stories by the names of the bugs."""
    lines = [line for line in STORIES.read_text(encoding="utf-8").splitlines() if line]
    found = {}
    for head, cause in zip(lines[::2], lines[1::2], strict=True):
        name, schedule = head.split(maxsplit=1)
        found[name] = Story(schedule, "" if cause.strip() == NOTHING else cause.strip())
    return found


def told(bug: Bug, schedule: str) -> Told | None:
    """Return the reported cause of a run, or None if the run does not show the bug."""
    trial, parsed = reference_trial(bug.folder), Schedule.parse(schedule)
    policy = MoveNotingPolicy(parsed.policy() or Policy())
    verdict = trial.fly(parsed, policy=policy).verdict
    failure = next((failure for failure in verdict.failures if failure.kind in bug.kinds), None)
    return None if failure is None else story_of(trial, verdict, failure, policy.made)


def by_moves(bug: Bug, schedule: str) -> str:
    """Return the same schedule with its moves by name, which other versions of Python make as well."""
    parsed = Schedule.parse(schedule)
    policy = MoveNotingPolicy(parsed.policy() or Policy())
    reference_trial(bug.folder).fly(parsed, policy=policy)
    return parsed.by_moves(made.move for made in policy.made).text()


def write(names: list[str]) -> None:
    """Tell the stories of these bugs, or of all, under the schedules that the file has, while they show the bugs."""
    stories = read() if STORIES.is_file() else {}
    for bug in [by_name(name) for name in names] or BUGS:
        schedule = stories[bug.name].schedule if bug.name in stories else load()[bug.name]["shrunk"]["schedule"]
        story = told(bug, schedule)
        if story is None:
            verdicts = simplest(reference_trial(bug.folder), shown_by(load(), bug.name))
            assert verdicts
            schedule = shrunk(bug, verdicts).schedule
            story = told(bug, schedule)
        schedule = by_moves(bug, schedule)
        story = told(bug, schedule)
        assert story is not None, f"{schedule} does not show {bug.name}"
        stories[bug.name] = Story(schedule, story.cause)
    blocks = (f"{bug.name} {stories[bug.name].schedule}\n    {stories[bug.name].cause or NOTHING}\n" for bug in BUGS)
    STORIES.write_text("\n".join(blocks), encoding="utf-8")
