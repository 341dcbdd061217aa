"""`cfepy explore --replay-all`: fly the failures of a results file again in the current mission."""

from __future__ import annotations

import argparse
from collections import Counter
from collections.abc import Iterator

from cfepy.cli.json_output import check_ci_outputs, check_json, wants_ci_outputs, write_json
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.options import refuse_run_options
from cfepy.extra.exploration import GONE, NOT_POSSIBLE, STILL_THERE, ReplayedFailure, replay_all


def run(arguments: argparse.Namespace) -> int:
    """Fly the failures again, and report which are gone.

    Returns:
        The exit status.

    Raises:
        UsageError: the file is not a results file, the mission cannot be flown, or an option is for a search.
    """
    path = arguments.replay_all
    refuse_run_options(
        arguments, "cannot be combined with --replay-all, because the results file sets it; leave it out"
    )
    check_json(arguments)
    check_ci_outputs(arguments)
    found = []
    for each in replay_all(path, arguments.mission, arguments.jobs, arguments.longest):
        found.append(each)
        if not arguments.quiet or each.state != GONE or each.verdict.trouble:
            print("\n".join(_lines(each)), flush=True)
    if wants_ci_outputs(arguments):
        from cfepy.extra.exploration.commands.explored_cases import write_replayed

        write_replayed(arguments, found)
    print(_summary(found))
    write_json(arguments, {"failures": [each.to_dict() for each in found]})
    is_wrong = any(each.state == STILL_THERE or each.verdict.trouble for each in found)
    return FOUND_PROBLEMS if is_wrong else ENDED_WELL


def _lines(each: ReplayedFailure) -> Iterator[str]:
    yield f"{each.state}: {each.title if each.same is None else each.same.title}"
    if each.verdict.trouble:
        yield f"  an error in cfepy itself; please report it: {each.verdict.trouble.splitlines()[-1]}"
    if each.state == NOT_POSSIBLE:
        schedule, missed = each.verdict.schedule, each.verdict.missed
        parts, count = ("moves", len(schedule.moves)) if schedule.moves else ("deviations", len(schedule.deviations))
        yield f"  {count - len(missed)} of its {count} {parts} were possible; not possible: {', '.join(missed)}"
    for other in each.others:
        yield f"  but under its schedule: {other}"
    if each.state == STILL_THERE or each.others:
        yield f"  replay: {each.command}"


def _summary(found: list[ReplayedFailure]) -> str:
    counts = Counter(each.state for each in found)
    told = [
        f"{counts[state]} {text}"
        for state, text in (
            (STILL_THERE, "still there"),
            (GONE, "gone"),
            (NOT_POSSIBLE, "whose schedule no longer applies"),
        )
        if counts[state]
    ]
    failures = "1 failure" if len(found) == 1 else f"{len(found)} failures"
    return f"{failures}: {', '.join(told)}" if found else "no failure in the results file"
