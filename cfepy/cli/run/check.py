"""`cfepy check`: print everything that is wrong with a mission, a line each: `file:line: what; what to do`.

Warnings follow the errors, as `file:line: warning: what`.
"""

from __future__ import annotations

import argparse
from pathlib import Path

from cfepy.cli.json_output import check_ci_outputs, check_json, wants_ci_outputs, write_json
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.mission import read_mission
from cfepy.pilot import MissionProblem, check_mission, problem_of, shown_file
from cfepy.status import UsageError

_MISTAKE, _WARNING = "mistake", "warning"
_KINDS = {
    _MISTAKE: "the mission cannot run as it is",
    _WARNING: "the mission runs, but probably not as its author intended",
}


def run(arguments: argparse.Namespace) -> int:
    """Check the mission that the command line names.

    Returns:
        The exit status: 0 if only warnings or nothing were found.

    Raises:
        UsageError: there is no such mission, or the JSON cannot be written.
    """
    check_json(arguments)
    check_ci_outputs(arguments)
    findings = check_mission(arguments.mission, arguments.board, dict(arguments.launch_args), arguments.cpp_nodes)
    if arguments.faults is not None:
        findings += _check_faults(arguments, flies=all(finding.is_warning for finding in findings))
    errors = [finding for finding in findings if not finding.is_warning]
    warnings = [finding for finding in findings if finding.is_warning]
    for finding in (*errors, *warnings):
        print(finding)
    packages = sorted({finding.package for finding in findings if finding.package})
    if packages:
        print(f"install the missing packages: pip install {' '.join(packages)}")
    counts = [_counted(len(errors), "problem"), _counted(len(warnings), "warning")]
    print(f"{', '.join(filter(None, counts)) or 'nothing'} found")
    write_json(arguments, _as_json(errors, warnings))
    if wants_ci_outputs(arguments):
        _write_ci_outputs(arguments, [*errors, *warnings])
    return FOUND_PROBLEMS if errors else ENDED_WELL


def _counted(number: int, what: str) -> str:
    return f"{number} {what}{'s' if number > 1 else ''}" if number else ""


def _as_json(errors: list[MissionProblem], warnings: list[MissionProblem]) -> dict[str, object]:
    found = [
        {
            "file": str(each.file),
            "line": each.line or None,
            "text": each.text,
            "is_warning": each.is_warning,
            "package": each.package,
        }
        for each in (*errors, *warnings)
    ]
    return {"problems": len(errors), "warnings": len(warnings), "found": found}


def _write_ci_outputs(arguments: argparse.Namespace, problems: list[MissionProblem]) -> None:
    """Write a finding for each problem, and a failed test case for each error."""
    from cfepy.cli.ci_outputs import write_ci_outputs
    from cfepy.writing.ci_findings import ERROR, WARNING, CiFinding, FindingPlace
    from cfepy.writing.junit import FAILURE, Case, Problem, Suite

    findings = []
    for each in problems:
        rule, level = (_WARNING, WARNING) if each.is_warning else (_MISTAKE, ERROR)
        findings.append(CiFinding(rule, each.message, (FindingPlace(each.file.absolute(), each.line),), level))
    cases = [
        Case(shown_file(place.file), text, problems=(Problem(FAILURE, text, rule),), place=place)
        for rule, text, (place,), level in findings
        if level == ERROR
    ]
    suite = Suite(f"cfepy check {arguments.mission}", cases or [Case("check", "no mistakes")])
    write_ci_outputs(arguments, "cfepy check", suite, findings, _KINDS)


def _check_faults(arguments: argparse.Namespace, flies: bool) -> list[MissionProblem]:
    """Return the errors of a fault plan. A mission that cannot boot is not searched for targets."""
    from cfepy.faults import check_plan, look_at, plan_of, read_plan

    try:
        spec = read_mission(arguments.mission, dict(arguments.launch_args))
        plan = plan_of(arguments.faults, spec) if flies else read_plan(arguments.faults)
        errors = check_plan(plan, spec, look_at(spec) if flies else None)
    except UsageError as error:
        errors = list(error.each)
    return [problem_of(error, Path(arguments.faults)) for error in errors]
