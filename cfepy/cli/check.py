"""`cfepy check`: print everything that is wrong with a mission, a line each: `file:line: what; what to do`."""

from __future__ import annotations

import argparse
import os
from pathlib import Path

from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.mission.check import Finding, check_mission


def run(arguments: argparse.Namespace) -> int:
    """Check the mission that the command line names.

    Returns:
        The exit status: 0 when nothing was found.

    Raises:
        UsageError: there is no such mission.
    """
    findings = check_mission(arguments.mission, arguments.board, dict(arguments.launch_args))
    for finding in findings:
        print(_line(finding))
    count = len(findings)
    print("nothing found" if not count else f"{count} {'problem' if count == 1 else 'problems'} found")
    return FOUND_PROBLEMS if findings else ENDED_WELL


def _line(finding: Finding) -> str:
    place = _shown(finding.file)
    return f"{place}:{finding.line}: {finding.text}" if finding.line else f"{place}: {finding.text}"


def _shown(path: Path) -> str:
    """A path as short as it can be named from here."""
    try:
        return os.path.relpath(path) if path.is_relative_to(Path.cwd()) else str(path)
    except OSError:
        return str(path)
