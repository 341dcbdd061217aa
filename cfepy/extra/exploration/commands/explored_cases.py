"""The failures of an exploration as test cases and findings, for `--junit`, `--sarif` and `--github`."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Iterable, Iterator, Sequence

from cfepy.cli.ci_outputs import write_ci_outputs
from cfepy.cli.run.run_cases import KINDS, rule_of
from cfepy.extra.exploration import GONE, STILL_THERE, ReplayedFailure, Report, Told, Verdict
from cfepy.pilot import Failure, SourcePlaces, name_of_group
from cfepy.units import NS_PER_S
from cfepy.writing.ci_findings import ERROR, CiFinding, FindingPlace
from cfepy.writing.junit import ERROR as ERROR_CASE
from cfepy.writing.junit import FAILURE, SKIPPED, Case, Problem, Suite

TOOL = "cfepy explore"
TROUBLE, UNSTEADY = "error-in-cfepy", "not-deterministic"
_KINDS = {
    **KINDS,
    TROUBLE: "an error in cfepy itself; please report it",
    UNSTEADY: "two runs under one schedule differ",
}
_CLASS = "explore"


def write_report(arguments: argparse.Namespace, report: Report, about: Callable[[Told], Iterable[str]]) -> None:
    """Write the outputs for an exploration that the command line asks for.

    Args:
        arguments: the command line with the options of `add_ci_outputs`.
        report: of the exploration.
        about: returns the lines about a failure.

    Raises:
        UsageError: a file cannot be written.
    """
    plan, tally = report.trial.plan, report.tally
    spec = plan.spec()
    places = SourcePlaces(spec, plan.script)
    found = [_failure(report, told, places, about) for told in report.findings]
    found += [_trouble(each) for each in report.troubles]
    if report.unsteady is not None:
        text = f"two runs under {report.unsteady} differ"
        place = FindingPlace(spec.script.absolute())
        problem = Problem(ERROR_CASE, text, UNSTEADY)
        found.append((CiFinding(UNSTEADY, text, (place,)), Case(_CLASS, UNSTEADY, problems=(problem,), place=place)))
    cases = [case for _, case in found] or [Case(_CLASS, "no failure", report.reference.end_ns / NS_PER_S)]
    properties = {
        "mission": " ".join(plan.words),
        "seed": str(plan.seed),
        "schedules": str(tally.done),
        "failed": str(tally.failed),
        "interrupted": str(tally.interrupted).lower(),
    }
    suite = Suite(f"{TOOL} {spec.name}", cases, properties)
    write_ci_outputs(arguments, TOOL, suite, [finding for finding, _ in found], _KINDS)


def _failure(
    report: Report, told: Told, places: SourcePlaces, about: Callable[[Told], Iterable[str]]
) -> tuple[CiFinding, Case]:
    failure, shrunk = told.finding.failure, told.shrunk
    trial, schedule = report.trial, report.schedule_of(told)
    if shrunk is not None:
        trial, schedule = shrunk.trial, shrunk.verdict.schedule
    lines = [failure.title, *([f"cause: {told.story.cause}"] if told.story.cause else [])]
    text = "\n".join([*lines, f"replay: {trial.command(schedule)}"])
    found = CiFinding(rule_of(failure.kind), text, places.of(failure, told.story.cause))
    problem = Problem(FAILURE, "\n".join(lines), found.rule, "\n".join(about(told)))
    seconds = _seconds(failure, told.finding.verdict)
    return found, Case(_CLASS, failure.name, seconds, (problem,), found.places[0])


def _seconds(failure: Failure | None, verdict: Verdict) -> float:
    """Return the virtual time of a test case: until the failure, or of the whole run, in s."""
    at_ns = None if failure is None else failure.at_ns
    return (verdict.end_ns if at_ns is None else at_ns) / NS_PER_S


def _trouble(verdict: Verdict) -> tuple[CiFinding, Case]:
    text = f"an error in cfepy itself, under {verdict.schedule}"
    problem = Problem(ERROR_CASE, text, TROUBLE, verdict.trouble)
    return CiFinding(TROUBLE, f"{text}\n{verdict.trouble}"), Case(_CLASS, TROUBLE, problems=(problem,))


def write_replayed(arguments: argparse.Namespace, found: Sequence[ReplayedFailure]) -> None:
    """Write the outputs for the replayed failures of a results file.

    Args:
        arguments: the command line with the options of `add_ci_outputs`.
        found: the failures.

    Raises:
        UsageError: a file cannot be written.
    """
    cases = [_replayed_case(each) for each in found] or [Case(_CLASS, "no failure in the results file")]
    suite = Suite(f"{TOOL} --replay-all", cases, {"results": arguments.replay_all})
    write_ci_outputs(arguments, f"{TOOL} --replay-all", suite, list(_replayed_findings(found)), _KINDS)


def _replayed_case(each: ReplayedFailure) -> Case:
    name, seconds = name_of_group(each.group), _seconds(each.same, each.verdict)
    if each.verdict.trouble:
        problem = Problem(ERROR_CASE, "an error in cfepy itself", TROUBLE, each.verdict.trouble)
        return Case(_CLASS, name, seconds, (problem,))
    if each.state == GONE:
        return Case(_CLASS, name, seconds)
    kind, title = (
        FAILURE if each.state == STILL_THERE else SKIPPED,
        each.title if each.same is None else each.same.title,
    )
    return Case(_CLASS, name, seconds, (Problem(kind, f"{each.state}: {title}", detail=f"replay: {each.command}"),))


def _replayed_findings(found: Sequence[ReplayedFailure]) -> Iterator[CiFinding]:
    """Yield a finding for each failure that is still there, and for each error in cfepy."""
    for each in found:
        if each.verdict.trouble:
            yield _trouble(each.verdict)[0]
        elif each.same is not None:
            plan = each.trial.plan
            text = f"{each.state}: {each.same.title}\nreplay: {each.command}"
            places = SourcePlaces(plan.spec(), plan.script)
            yield CiFinding(rule_of(each.same.kind), text, places.of(each.same), ERROR)
