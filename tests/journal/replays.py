"""Recording a run and replaying it on both kinds of tasks, for every test that has a run to record."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

from cfepy.attachment import Attachment
from cfepy.journal import Journal, read_journal, record, replay
from cfepy.pilot.pilot import Flown
from cfepy.pilot.plan import RunPlan
from cfepy.schedules.schedule import Schedule

CONTEXTS = ("thread", "greenlet")


def assert_replays(plan: RunPlan, folder: Path, attachments: Sequence[Attachment] = ()) -> Flown:
    """Record a run, and assert that its journal gives the same run on threads and on greenlets.

    Args:
        plan: the plan to run.
        folder: folder in which the journal may be written.
        attachments: observers of the recorded run; a replay must need none of them.

    Returns:
        The recorded run.
    """
    flown = record(plan, folder / "run.cfepy", attachments)
    assert_same_again(read_journal(folder / "run.cfepy"), flown.trace)
    return flown


def assert_same_again(journal: Journal, trace: str) -> None:
    """Assert that a journal gives a certain run on threads and on greenlets, and that this was the recorded one."""
    assert journal.end is not None
    assert journal.end.trace == trace
    for tasks in CONTEXTS:
        again = replay(journal, tasks=tasks)
        assert again.verdict.difference is None, f"{tasks}: {again.verdict.difference}"
        assert again.verdict.same, f"{tasks}: the numbers of the report differ"
        assert again.verdict.whole
        assert again.flown.trace == trace


def plan_for(mission: str, seconds: float | None = None, schedule: str = "fifo", **options: object) -> RunPlan:
    """Return the plan of `cfepy run MISSION`."""
    plan = RunPlan((mission,), seconds=seconds, schedule=Schedule.parse(schedule))
    return replace(plan, **options)  # type: ignore[arg-type]
