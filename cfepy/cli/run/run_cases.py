"""A run as test cases and findings, for `--junit`, `--sarif` and `--github`.

The boot is a test case, and so is each step of the script, each invariant and each deadline. Each other problem is a
failed test case.
"""

from __future__ import annotations

import argparse
from collections.abc import Iterator, Mapping
from dataclasses import replace
from pathlib import Path

from cfepy.cli.ci_outputs import write_ci_outputs
from cfepy.cli.run.report import outcome_of
from cfepy.pilot import Failure, FailureKind, Flown, RunPlan, RunProblem, SourcePlaces
from cfepy.script import StepVerdict
from cfepy.writing.ci_findings import CiFinding, FindingPlace
from cfepy.writing.junit import ERROR, FAILURE, SKIPPED, Case, Problem, Suite

MEANINGS: Mapping[str, str] = {
    FailureKind.DIED: "an exception ended an application",
    FailureKind.RAISED: "a node printed the traceback of an exception",
    FailureKind.ENDED: "an application or a node ended with an error",
    FailureKind.RESET: "a failure reset the processor",
    FailureKind.DEADLINE: "a deadline of the mission file was missed",
    FailureKind.DEADLOCK: "tasks wait for each other",
    FailureKind.RACE: "two accesses, one of them a write, have no order",
    FailureKind.OVERWRITE: "compiled code wrote past its memory",
    FailureKind.LEAK: "an application ended with something that it took from cFE",
    FailureKind.WAITING_LOAD: "a table's load waits for an application that holds the table's address",
    FailureKind.STUCK: "a task waits for something that no task can end",
    FailureKind.STALLED: "a task does not give up the CPU",
    FailureKind.EXPECTATION: "a step of the script failed",
    FailureKind.INVARIANT: "an invariant of the mission file does not hold",
    FailureKind.EVENT: "an application sent an ERROR or CRITICAL event",
    FailureKind.PROBLEM: "the mission or a mission beside it has another problem",
    FailureKind.RESULTS: "results depend on the schedule",
    FailureKind.LONGEST: "a time is longer than allowed",
    FailureKind.STARVED: "a ready task does not run for too long",
    FailureKind.LIVELOCK: "an application runs for too long without a message",
}
"""The meaning of each kind of failures, in a sentence."""
NOT_OPERATIONAL = "the run ended before the mission was OPERATIONAL; run it for longer (--for)"
_NEVER_JUDGED = Problem(SKIPPED, "never judged")
_HAVE_CASES = (FailureKind.INVARIANT, FailureKind.DEADLINE)


def rule_of(kind: str) -> str:
    """Return the id of a kind of failures for SARIF and GitHub: `data-race`."""
    return kind.replace(" ", "-")


KINDS = {rule_of(kind): text for kind, text in MEANINGS.items()}


def write_run(arguments: argparse.Namespace, plan: RunPlan, flown: Flown) -> None:
    """Write the outputs for a run that the command line asks for.

    Args:
        arguments: the command line with the options of `add_ci_outputs`.
        plan: the run.
        flown: its end.

    Raises:
        UsageError: a file cannot be written.
    """
    places = SourcePlaces(flown.mission.spec, plan.script)
    name = flown.mission.spec.name
    suite = Suite(f"cfepy {plan.command} {name}", list(_cases(name, flown, places)), _properties(plan, flown))
    findings = [each for problem in flown.problems for each in findings_of(problem, places)]
    write_ci_outputs(arguments, f"cfepy {plan.command}", suite, findings, KINDS)


def findings_of(problem: RunProblem, places: SourcePlaces) -> Iterator[CiFinding]:
    """Yield a finding for each failure of a problem; a problem that only follows from others has none."""
    for failure in problem.failures:
        text = problem.text if len(problem.failures) == 1 else failure.title
        yield CiFinding(rule_of(failure.kind), text, places.of(failure))


def _properties(plan: RunPlan, flown: Flown) -> dict[str, str]:
    results = flown.results
    return {
        "command": plan.command_line(),
        "outcome": outcome_of(flown),
        "board": results.board,
        "seed": str(plan.seed),
        "schedule": plan.schedule.text(),
        "virtual_s": f"{results.virtual_s:.6f}",
        "trace": flown.trace,
    }


def _cases(name: str, flown: Flown, places: SourcePlaces) -> Iterator[Case]:
    results = flown.results
    boot = () if results.booted_s is not None or flown.mission.over else (Problem(ERROR, NOT_OPERATIONAL),)
    yield Case(name, "boot", results.booted_s or 0.0, boot)
    if flown.outcome is not None:
        file, before_s = Path(flown.outcome.file).absolute(), results.booted_s or 0.0
        for step in flown.outcome.verdicts:
            yield _step_case(f"{name}.script", step, before_s, file)
            before_s = max(before_s, step.at_s)
    failed = {(each.kind, each.who): each for problem in flown.problems for each in problem.failures}
    for invariant in results.invariants:
        violated = failed.get((FailureKind.INVARIANT, invariant.name))
        case = _rule_case(f"{name}.invariants", invariant.name, violated, places)
        yield case if invariant.judged or violated is not None else replace(case, problems=(_NEVER_JUDGED,))
    for deadline in results.deadlines:
        text = deadline.problem
        failure = None if text is None else failed.get((FailureKind.DEADLINE, deadline.owner))
        case = _rule_case(f"{name}.deadlines", f"{deadline.owner} {deadline.kind}", failure, places, text or "")
        yield case if deadline.checked else replace(case, problems=(_NEVER_JUDGED,))
    for problem in flown.problems:
        kinds = {failure.kind for failure in problem.failures}
        if not problem.is_step and not kinds.intersection(_HAVE_CASES):
            yield _problem_case(name, problem, places)


def _step_case(suite: str, step: StepVerdict, before_s: float, file: Path) -> Case:
    kind = SKIPPED if step.follows else FAILURE
    text = step.detail or step.step
    problems = () if step.ok else (Problem(kind, text, rule_of(FailureKind.EXPECTATION)),)
    return Case(
        suite, f"{step.line}: {step.step}", max(0.0, step.at_s - before_s), problems, FindingPlace(file, step.line)
    )


def _rule_case(suite: str, name: str, failure: Failure | None, places: SourcePlaces, text: str = "") -> Case:
    if failure is None:
        return Case(suite, name)
    found = Problem(FAILURE, text or failure.text, rule_of(failure.kind), failure.detail)
    return Case(suite, name, problems=(found,), place=next(iter(places.of(failure)), None))


def _problem_case(suite: str, problem: RunProblem, places: SourcePlaces) -> Case:
    first = problem.failures[0] if problem.failures else None
    title, _, rest = problem.text.partition("\n")
    if first is None:
        return Case(suite, title, problems=(Problem(FAILURE, title, detail=rest),))
    kind, place = rule_of(first.kind), next(iter(places.of(first)), None)
    found = Problem(FAILURE, title, kind, first.detail or rest)
    return Case(suite, f"{kind} {first.who}".rstrip(), problems=(found,), place=place)
