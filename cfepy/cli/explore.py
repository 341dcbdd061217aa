"""`cfepy explore`: run a mission under many schedules, and report what fails under some of them."""

from __future__ import annotations

import argparse
import json
import sys
from collections.abc import Mapping
from dataclasses import replace
from pathlib import Path
from typing import Any

from cfepy.cli.explore_report import Report, show
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.run import output_path
from cfepy.explore.campaign import Campaign, Crew, Tally
from cfepy.explore.crews import make_crew
from cfepy.explore.findings import Finding, Findings
from cfepy.explore.inventory import files_read, identity_of
from cfepy.explore.progress import make_progress
from cfepy.explore.results_file import ResultsFile
from cfepy.explore.search import SeededSearch, SystematicSearch, make_search
from cfepy.explore.shipment import ship
from cfepy.explore.shrink import Shrinker, Shrunk
from cfepy.explore.stuck import waits_of
from cfepy.explore.timeline import timeline
from cfepy.explore.trial import Trial
from cfepy.explore.verdict import Verdict
from cfepy.explore.workers import PROCESS_DIED
from cfepy.mission.run_plan import NODE, RUN, RunPlan
from cfepy.rtos.schedule import Schedule
from cfepy.status import UsageError

BASE = "at"  # fifo as a policy, which is asked, so that decisions can be counted and options count


def run(arguments: argparse.Namespace) -> int:
    """Explore the mission that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: it cannot be explored like this.
    """
    numbers = output_path(arguments.json)
    options = _options(arguments)
    plan = _plan(arguments)
    bare = Trial(plan, arguments.events, keep_widths=arguments.policy == "dfs")
    reference, results = bare.fly(options.text())
    trial = bare.against(results)
    if not arguments.no_stuck and reference.end_ns:
        trial = replace(trial, waits=waits_of(plan, reference.end_ns, options.policy()))
    findings = Findings(reference)
    search = make_search(arguments.policy, arguments.depth, reference.decisions, options, arguments.first_seed)
    tally = _fly(arguments, trial, search, findings, reference)
    report = _report(arguments, trial, reference, findings, tally)
    show(report, sys.stdout)
    if numbers is not None:
        _write(numbers, report.to_dict())
    if tally.interrupted:
        return INTERRUPTED
    return FOUND_PROBLEMS if report.findings or findings.troubles else ENDED_WELL


def _options(arguments: argparse.Namespace) -> Schedule:
    words = [BASE]
    words += ["any"] if arguments.any_priority else []
    for option in ("hold", "from"):
        time = getattr(arguments, option)
        words += [f"{option}={time}"] if time else []
        try:
            Schedule.parse(":".join(words))
        except UsageError as error:
            raise UsageError(error.text, field=f"--{option}") from None
    return Schedule.parse(":".join(words))


def _plan(arguments: argparse.Namespace) -> RunPlan:
    """The run; a Python file is a node, and gets the words behind it."""
    is_node = arguments.words[0].endswith(".py")
    if len(arguments.words) > 1 and not is_node:
        raise UsageError(f"one mission at a time; {arguments.words[1]!r} is one too many", field="MISSION")
    return RunPlan(
        tuple(arguments.words),
        NODE if is_node else RUN,
        tuple(arguments.launch_args),
        arguments.seconds,
        arguments.seed,
        arguments.board,
        arguments.tasks,
        script=arguments.script,
        faults=arguments.faults,
    )


def _fly(
    arguments: argparse.Namespace,
    trial: Trial,
    search: SeededSearch | SystematicSearch,
    findings: Findings,
    reference: Verdict,
) -> Tally:
    """Run all schedules, or until the first failure."""
    if arguments.until_failure and reference.failed:
        return Tally()
    needs_files = arguments.results is not None or arguments.cluster is not None
    files = files_read(trial.plan) if needs_files else []
    file = None if arguments.results is None else ResultsFile(arguments.results, _identity(arguments, trial, files))
    crew: Crew = make_crew(
        arguments.seeds, arguments.jobs, arguments.cluster, lambda: ship(trial.plan, files), arguments.longest
    )
    resumed = 0 if file is None else len(file)
    progress = make_progress(sys.stderr, arguments.seeds, resumed, arguments.quiet)

    def take(number: int, verdict: Verdict) -> bool:
        return findings.take(number, verdict) and bool(arguments.until_failure)

    return Campaign(trial, search, arguments.seeds, crew, file, progress).run(take)


def _identity(arguments: argparse.Namespace, trial: Trial, files: list[str]) -> dict[str, Any]:
    names = ("policy", "depth", "first_seed", "any_priority", "hold", "from", "events", "no_stuck")
    return identity_of(trial.plan, files, {name: getattr(arguments, name) for name in names})


def _report(
    arguments: argparse.Namespace, trial: Trial, reference: Verdict, findings: Findings, tally: Tally
) -> Report:
    """What was found, each failure shrunk and with its timeline."""
    report = Report(trial, reference, tally, findings.troubles)
    for finding in findings.all():
        shrunk, lines = None, []
        try:
            shrunk = None if tally.interrupted else _shrunk(arguments, trial, finding)
            lines = _timeline(shrunk, finding) if shrunk is not None else []
        except KeyboardInterrupt:  # what was found must not be lost with it
            tally.interrupted = True
        report.findings.append((finding, shrunk, lines))
    return report


def _shrunk(arguments: argparse.Namespace, trial: Trial, finding: Finding) -> Shrunk | None:
    """The fewest preemptions; None for a failure that needs none, or ends the process that flies it."""
    if not arguments.shrink or finding.in_reference or finding.failure.kind == PROCESS_DIED:
        return None
    if not arguments.quiet and sys.stderr.isatty():
        print("cfepy: shrinking", finding.failure.title, file=sys.stderr, flush=True)
    return Shrinker(trial, finding.simplest.schedule, finding.failure.group, arguments.shrink).run()


def _timeline(shrunk: Shrunk, finding: Finding) -> list[str]:
    failure = shrunk.verdict.failure(finding.failure.group)
    return [] if failure is None else timeline(shrunk.trial, shrunk.verdict, failure, shrunk.moves)


def _write(file: Path, numbers: Mapping[str, Any]) -> None:
    try:
        file.write_text(json.dumps(numbers, indent=2) + "\n", encoding="utf-8")
    except OSError as error:
        raise UsageError(f"could not be written: {error.strerror}", file=str(file), field="--json") from None
