"""`cfepy check`: print everything that is wrong with a mission, a line each: `file:line: what; what to do`."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.mission import read_mission
from cfepy.mission.check import Finding, check_mission
from cfepy.status import UsageError


def run(arguments: argparse.Namespace) -> int:
    """Check the mission that the command line names.

    Returns:
        The exit status: 0 when nothing was found.

    Raises:
        UsageError: there is no such mission.
    """
    findings = check_mission(arguments.mission, arguments.board, dict(arguments.launch_args))
    if arguments.faults is not None:
        findings += _check_faults(arguments, flies=not findings)
    for finding in findings:
        print(_line(finding))
    count = len(findings)
    print("nothing found" if not count else f"{count} {'problem' if count == 1 else 'problems'} found")
    return FOUND_PROBLEMS if findings else ENDED_WELL


def _check_faults(arguments: argparse.Namespace, flies: bool) -> list[Finding]:
    """What is wrong with a fault plan; a mission that cannot boot is not asked what there is in it."""
    from cfepy.faults import read_plan
    from cfepy.mission.fault_check import check_plan
    from cfepy.mission.fault_plans import look_at

    try:
        plan = read_plan(arguments.faults)
        spec = read_mission(arguments.mission, dict(arguments.launch_args))
        errors = check_plan(plan, spec, look_at(spec) if flies else None)
    except UsageError as error:
        errors = [error]
    return [_finding(error, Path(arguments.faults)) for error in errors]


def _finding(error: UsageError, file: Path) -> Finding:
    text = f"{error.field}: {error.text}" if error.field else error.text
    return Finding(Path(error.file or file), error.line or 0, text)


def _line(finding: Finding) -> str:
    place = _shown(finding.file)
    return f"{place}:{finding.line}: {finding.text}" if finding.line else f"{place}: {finding.text}"


def _shown(path: Path) -> str:
    """A path as short as it can be named from here."""
    try:
        return os.path.relpath(path) if path.is_relative_to(Path.cwd()) else str(path)
    except OSError:
        return str(path)
