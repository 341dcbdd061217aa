"""`cfepy explore`: run a mission under many schedules, and report what fails under some of them.

Each failure is reported once, with the command that replays it and its timeline.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterator
from dataclasses import replace
from typing import TextIO

from cfepy.cli.json_output import check_ci_outputs, check_json, wants_ci_outputs, write_json
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.options import plan_of_mission
from cfepy.cli.user_notes import tell
from cfepy.extra.exploration import WIDTH, Expedition, Finding, Report, Told, Worst, story_width
from cfepy.extra.exploration.commands import AUTO, DEFAULT_SEEDS
from cfepy.pilot import RunPlan
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from cfepy.units import instant_text, time_text

RUNS_THAT_ARE_COMPARED = 2
SHRINK_OPTION = "--shrink-time"
INDENT = 2  # of the lines about a failure


def show(report: Report, stream: TextIO, quiet: bool = False) -> None:
    """Print a report.

    Args:
        report: the report.
        stream: the output.
        quiet: print only the failures, the summary and the notes.
    """
    width = story_width(stream.isatty(), INDENT)
    for number, told in enumerate(report.findings, 1):
        seen = "failure" if told.repeats else "seen once and not again: failure"
        print(f"{seen} {number}: {told.finding.failure.title}", file=stream)
        for line in _about(report, told, width):
            print(f"{' ' * INDENT}{line}".rstrip(), file=stream)
        print(file=stream)
    if report.worst is not None:
        for line in _longest(report, report.worst, width):
            print(line.rstrip(), file=stream)
        print(file=stream)
    for trouble in report.troubles[:1]:
        print(f"an error in cfepy itself, under {trouble.schedule}; please report it:", file=stream)
        print(trouble.trouble, file=stream)
    print(summary(report), file=stream)
    for note in report.notes:
        print(f"  {note}", file=stream)
    if not quiet and report.is_steady and (not report.findings or report.breadth.seen is not None):
        for line in report.breadth.lines():
            print(f"  {line}", file=stream)
    elif not quiet and report.breadth.switches is not None:
        print(f"  {report.breadth.switches.line()}", file=stream)


def summary(report: Report) -> str:
    """Return the last line: the numbers of schedules, of failures, and of distinct failures."""
    tally = report.tally
    if not report.is_steady:
        return "no schedules: two runs under fifo differ"
    parts = [f"{tally.done} schedules", f"{tally.failed} failed"]
    if tally.troubled:
        parts.append(f"{tally.troubled} with an error in cfepy itself")
    if tally.resumed:
        parts.append(f"{tally.resumed} from the results file")
    if tally.interrupted:
        parts.append("ended by Ctrl-C")
    kinds = len(report.findings)
    found = "no failure" if not kinds else "1 distinct failure" if kinds == 1 else f"{kinds} distinct failures"
    return f"{', '.join(parts)}: {found}"


def _about(report: Report, told: Told, width: int) -> Iterator[str]:
    finding, shrunk = told.finding, told.shrunk
    failure = finding.failure
    if failure.at_ns is not None:
        yield f"at {instant_text(failure.at_ns)}"
    yield from failure.detail.splitlines()
    for other in finding.others:
        yield f"and in the same run: {other}"
    for inversion in told.inversions:
        yield f"priority inversion before that: {inversion}"
    yield from _how_often(report, finding)
    yield f"replay: {report.trial.command(report.schedule_of(told))}"
    if shrunk is not None:
        yield f"shrunk: {shrunk.trial.command(shrunk.verdict.schedule)}"
        yield f"        {shrunk.text(SHRINK_OPTION)}"
        if shrunk.verdict.schedule.any_priority and not _asks_for_any_priority(report):
            yield "        fails only if less urgent tasks run beside more urgent ones, as on several cores (a board"
            yield "        with `cores: 1` leaves such schedules out)"
        for move in shrunk.moves:
            if move.question:
                yield f"        {move.task}: {move.chosen}"
    lines = told.story.lines(width)
    if lines:
        yield ""
        yield from lines


def _asks_for_any_priority(report: Report) -> bool:
    return report.breadth.options is not None and report.breadth.options.any_priority


def _longest(report: Report, worst: Worst, width: int) -> Iterator[str]:
    """Yield lines about the longest run: its time, the usual time, and the command that shows it."""
    found, longest = worst.distribution, worst.distribution.longest
    if longest is None or worst.schedule is None:
        yield f"worst {found.measure.text}: no value was measured; check the name"
        return
    fifo = "not measured" if found.under_fifo is None else time_text(found.under_fifo)
    yield f"worst {found.measure.text}: {time_text(longest.longest[0])}, under fifo {fifo}"
    shown = longest if worst.shrunk is None else worst.shrunk.verdict
    yield f"  ends at {instant_text(shown.longest[1])}"
    for inversion in worst.inversions:
        yield f"  priority inversion before that: {inversion}"
    if found.times:
        names = {"min": "shortest", "median": "median", "p99": "99 %", "max": "longest"}
        listed = ", ".join(f"{names[name]} {time_text(each)}" for name, each in found.quantiles().items())
        yield f"  {len(found.times)} schedules: {listed}"
    if found.number is not None:
        yield f"  number {found.number}: {report.trial.command(longest.schedule)}"
    if worst.shrunk is not None:
        yield f"  shrunk: {worst.shrunk.trial.command(worst.shrunk.verdict.schedule)}"
        yield f"          {worst.shrunk.text(SHRINK_OPTION)}"
    lines = worst.story.lines(width)
    if lines:
        yield ""
        yield from (f"  {line}" for line in lines)


def _how_often(report: Report, finding: Finding) -> Iterator[str]:
    if finding.in_reference:
        yield "under the default schedule, fifo, already"
    if finding.numbers:
        yield finding.frequency(report.tally.done)


def run(arguments: argparse.Namespace) -> int:
    """Explore the mission that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: the mission cannot be explored with these options.
    """
    if arguments.replay_all is not None:
        from cfepy.extra.exploration.commands.replay_all import run as replay

        return replay(arguments)
    if arguments.mission is None:
        raise UsageError("missing mission to explore", field="MISSION")
    check_json(arguments)
    check_ci_outputs(arguments)
    report = _expedition(arguments).run((lambda notes: None) if arguments.quiet else tell)
    if wants_ci_outputs(arguments):
        from cfepy.extra.exploration.commands.explored_cases import write_report

        write_report(arguments, report, lambda told: _about(report, told, WIDTH))
    show(report, sys.stdout, arguments.quiet)
    write_json(arguments, report.to_dict())
    if report.unsteady is not None and not report.tally.interrupted:
        _show_leak(report.trial.plan, report.unsteady)
        return FOUND_PROBLEMS
    if report.tally.interrupted:
        return INTERRUPTED
    return FOUND_PROBLEMS if report.findings or report.troubles else ENDED_WELL


def _show_leak(plan: RunPlan, schedule: Schedule) -> None:
    """Report where two runs under one schedule differ, as far as the place can be found."""
    from cfepy.cli.run.check_determinism import compare

    print(f"\nnot deterministic: two runs under {schedule} differ, so not the schedule alone decides", flush=True)
    if compare(replace(plan, schedule=schedule), RUNS_THAT_ARE_COMPARED) is not None:
        print(
            "such runs do not differ in separate processes: they depend on addresses "
            "of objects, or on state that a run leaves"
        )
        print("behind in its process")


def _expedition(arguments: argparse.Namespace) -> Expedition:
    """Return the exploration that the command line requests."""
    names = ("policy", "depth", "first_seed", "any_priority", "fair", "until_failure", "events", "jobs", "cluster")
    more = ("worst", "results", "shrink", "points")
    is_auto = arguments.seeds == AUTO
    usual = DEFAULT_SEEDS if arguments.budget is None else None
    return Expedition(
        plan_of_mission(arguments),
        seeds=None if is_auto else arguments.seeds or usual,
        until_known=is_auto,
        budget_s=arguments.budget,
        **{name: getattr(arguments, name) for name in (*names, *more)},
        hold_s=arguments.hold,
        starved_s=arguments.starved,
        livelock_s=arguments.livelock,
        connect_s=arguments.connect,
        from_s=getattr(arguments, "from"),
        stuck=not arguments.no_stuck,
        longest_s=arguments.longest,
        shrink_s=arguments.shrink_time,
        progress=None if arguments.quiet else sys.stderr,
    )
