"""The run that a command looks at: it is replayed from a journal, or flown from a mission, launch file or node.

For values over time it can also be a bag.
"""

from __future__ import annotations

import argparse
import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from cfepy.attachment import Attachment
from cfepy.cli.flying_progress import FlyingProgress
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.options import LONGEST_S, plan_of, refuse_run_options
from cfepy.cli.user_notes import tell, tell_briefly
from cfepy.ground import SeriesRecorder, SeriesSet, bag_series, is_bag
from cfepy.interpreter.host_system import command_line
from cfepy.pilot import DEFAULT_S, Flown, RunPlan, fly
from cfepy.rtos import Policy
from cfepy.status import UsageError
from cfepy.trace import Trace
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from cfepy.journal import Journal, Replay, Stage

StoryOf = Callable[[RunPlan, str], Any]
"""Returns the story of a run whose files are below a folder, which is empty if they have their own paths."""


def flight_plan(arguments: argparse.Namespace) -> RunPlan:
    """Make the plan of the run on the command line, 10 s by default, also for a node.

    Raises:
        UsageError: the schedule is invalid.
    """
    plan = plan_of(arguments, [arguments.source])
    return replace(plan, seconds=DEFAULT_S) if plan.seconds is None and plan.script is None else plan


@dataclass(frozen=True, slots=True)
class LookedAt:
    """A run that was looked at.

    Attributes:
        flown: the run.
        command: the command that repeats it.
        schedule: the schedule of the run.
        notes: messages for the user.
        warnings: why it is not the requested run; empty if it is.
        journal: name of the journal that was replayed; empty for a run that was flown.
        story: the result of `story_of`; None without one.
    """

    flown: Flown
    command: str
    schedule: str
    notes: tuple[str, ...] = ()
    warnings: tuple[str, ...] = ()
    journal: str = ""
    story: Any = None

    def status(self) -> int:
        """Print notes and warnings to standard error. Returns the exit status of the command."""
        stall = self.flown.stall
        tell_briefly(self.flown.notes)
        tell((*self.notes, *self.warnings, *([] if stall is None else [stall])))
        return FOUND_PROBLEMS if self.warnings or stall is not None else ENDED_WELL


def look_at(
    arguments: argparse.Namespace,
    attachments: Sequence[Attachment],
    watched: Callable[[Policy], Policy] = lambda policy: policy,
    trace: Trace | None = None,
    story_of: StoryOf | None = None,
) -> LookedAt:
    """Do the run that the command line names.

    Args:
        arguments: the command line.
        attachments: attachments that watch the run.
        watched: wraps the policy of a schedule that is given as deviations from fifo.
        trace: receives the records; None makes one.
        story_of: returns the story of a run whose schedule is given as deviations from fifo.

    Returns:
        The run.

    Raises:
        UsageError: there is no such run, or an option is for the other kind of source.
    """
    if _is_journal(arguments.source):
        return _replay(arguments, attachments, watched, trace, story_of)
    _refuse_from_disk(arguments)
    return _fly(arguments, attachments, watched, trace, story_of)


def _refuse_from_disk(arguments: argparse.Namespace) -> None:
    if arguments.from_disk:
        raise UsageError(f"only valid for a journal, and {arguments.source} is not one", field="--from-disk")


def look_at_series(arguments: argparse.Namespace, words: Sequence[str]) -> tuple[SeriesSet, int]:
    """Return the values over time of the run or the bag that the command line names, and the exit status.

    Args:
        arguments: the command line.
        words: the wanted values, as for `SeriesRecorder`.

    Raises:
        UsageError: there is no such run, bag or packet, or an option is for another kind of source.
    """
    if is_bag(arguments.source):
        refuse_run_options(
            arguments, f"only valid for a mission, and {arguments.source} is a bag; leave it out", but=["seconds"]
        )
        _refuse_from_disk(arguments)
        ends = [each for each in (arguments.seconds, arguments.until) if each is not None]
        return bag_series(arguments.source, words, min(ends, default=None)), ENDED_WELL
    recorder = SeriesRecorder(words)
    return recorder, look_at(arguments, [recorder]).status()


def _is_journal(source: str) -> bool:
    from cfepy.journal import is_journal

    try:
        return is_journal(source)
    except OSError:
        return False


def _fly(
    arguments: argparse.Namespace,
    attachments: Sequence[Attachment],
    watched: Callable[[Policy], Policy],
    trace: Trace | None,
    story_of: StoryOf | None,
) -> LookedAt:
    plan = flight_plan(arguments)
    if arguments.until is not None:
        plan = replace(plan, seconds=min(arguments.until, plan.seconds or LONGEST_S))
    policy = plan.schedule.policy()
    if policy is not None and plan.schedule.is_told:
        policy = watched(policy)
    flown = fly(plan, attachments=attachments, policy=policy, trace=trace, host=FlyingProgress())
    story = story_of(plan, "") if story_of is not None and plan.schedule.is_told else None
    return LookedAt(flown, plan.command_line(), plan.schedule.text(), story=story)


def _replay(
    arguments: argparse.Namespace,
    attachments: Sequence[Attachment],
    watched: Callable[[Policy], Policy],
    trace: Trace | None,
    story_of: StoryOf | None,
) -> LookedAt:
    from cfepy.journal import Replay, read_journal, staged

    refuse_run_options(
        arguments, f"only valid for a mission; the journal {arguments.source} contains this setting; leave it out"
    )
    journal = read_journal(arguments.source)
    until_ns = None if arguments.until is None else round(arguments.until * NS_PER_S)
    with staged(journal, arguments.from_disk) as stage:
        again = Replay(journal, stage, until_ns=until_ns)
        if again.policy is not None and journal.plan.schedule.is_told:
            again.policy = watched(again.policy)
        flown = again.fly(attachments, trace=trace, host=FlyingProgress())
        story = None if story_of is None else _story(journal, stage, again, flown, story_of)
    verdict = again.verdict
    warnings: tuple[str, ...] = ()
    if not verdict.same:
        warnings = (f"this is not the run of {arguments.source}: the replay differs", *stage.reasons)
    elif not verdict.proven:
        why = "the journal is truncated" if verdict.cut_off else "its first checkpoint comes later"
        text = f"this may not be the run of {arguments.source}: {why}"
        warnings = (f"{text}; it was compared up to record {verdict.agreed.records:,}",)
    until = [] if arguments.until is None else ["--until", f"{arguments.until:g}"]
    command = command_line(["cfepy", "replay", arguments.source, *until])
    name = os.path.basename(arguments.source)
    return LookedAt(flown, command, journal.plan.schedule.text(), stage.notes, warnings, name, story)


def _story(journal: Journal, stage: Stage, again: Replay, flown: Flown, story_of: StoryOf) -> Any:
    """Return the story of a replayed run, with the files of the replay.

    A run with input from outside has none, because its plan alone does not repeat it.
    """
    if not (journal.plan.schedule.is_told and again.verdict.same) or journal.pauses or journal.answers:
        return None
    plan = stage.plan
    plan = plan if plan.script is not None else replace(plan, seconds=flown.results.virtual_s)
    return story_of(plan, stage.root)
