"""`cfepy convert check`: check whether ROS nodes in C++ can be applications of cFE, with a line for each finding.

A line is `file:line:column: what: why; what to do [rule]`; warnings and notes come after the errors.
"""

from __future__ import annotations

import argparse
import json
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from cfepy import __version__
from cfepy.cli.json_output import STDOUT, check_json, write_json, write_text
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS
from cfepy.cli.user_notes import check_writable
from cfepy.extra.convert import RULES, CheckReport, Level, Profile, check_program, programs_of, sarif_of
from cfepy.extra.convert.commands import cpp_nodes_config
from cfepy.extra.convert.node_check import arena_size
from cfepy.status import UsageError

_ONLY_TO_CONVERT = {"output": "-o", "ids": "--ids", "force": "--force", "no_check": "--no-check", "cmake": "--cmake"}


def run(arguments: argparse.Namespace) -> int:
    """Check the programs that the command line names.

    Returns:
        The exit status: 0 when only warnings and notes were found.

    Raises:
        UsageError: there is nothing to check, or a file cannot be written.
    """
    words = arguments.words[1:]
    if not words:
        raise UsageError("missing argument: a package, a C++ source or a launch file", file="convert check")
    for name, option in _ONLY_TO_CONVERT.items():
        if getattr(arguments, name):
            raise UsageError(f"{option} cannot be combined with check, which writes no files")
    check_json(arguments)
    if arguments.sarif not in (None, STDOUT):
        check_writable(arguments.sarif, "--sarif")
    config = cpp_nodes_config(arguments)
    profile = Profile(config.profile)
    environ = dict(os.environ)
    reports = [check_program(each, profile, environ, config) for each in programs_of(words, environ)]
    _print(reports, profile)
    write_json(arguments, _as_json(reports, profile))
    if arguments.sarif is not None:
        text = json.dumps(sarif_of(reports, profile, __version__, Path.cwd()), indent=2) + "\n"
        write_text(arguments.sarif, text, "--sarif", arguments)
    return FOUND_PROBLEMS if any(each.is_refused for each in reports) else ENDED_WELL


def _print(reports: Sequence[CheckReport], profile: Profile) -> None:
    """Print the findings. A finding that several programs share is printed once."""
    counts = []
    for level in Level:
        found = sorted({finding for report in reports for finding in report.at(level)})
        for finding in found:
            print(finding.line(level))
        counts += [f"{len(found)} {level.value}{'s' if len(found) > 1 else ''}"] if found else []
    for report in reports:
        for memory in report.memory:
            print(
                f"{report.name}: {memory.topic} ({memory.type}): {memory.slots} x {memory.size:,} = "
                f"{memory.total:,} bytes"
            )
        if profile is not Profile.HOST:
            print(f"{report.name}: {arena_size(report.memory, profile, report.has_transforms)}")
    refused = sum(each.is_refused for each in reports)
    nodes = f"{len(reports)} node{'s' if len(reports) > 1 else ''}"
    print(f"{profile.value}: {nodes}, {refused} refused; {', '.join(counts) or 'nothing'} found")


def _as_json(reports: Sequence[CheckReport], profile: Profile) -> dict[str, Any]:
    return {"profile": profile.value, "nodes": [_node(each) for each in reports]}


def _node(report: CheckReport) -> dict[str, Any]:
    return {
        "name": report.name,
        "refused": report.is_refused,
        "found": [
            {
                **_place(each),
                "rule": each.rule,
                "level": str(RULES[each.rule].level(report.profile)),
                "text": each.message,
            }
            for each in report.findings
        ],
        "names": [
            {
                **_place(each),
                "kind": each.kind,
                "name": each.name,
                "text": each.text,
                "type": each.type,
                "queue": each.queue,
            }
            for each in report.names
        ],
        "memory": [
            {**_place(each), "topic": each.topic, "type": each.type, "slots": each.slots, "bytes_each": each.size}
            for each in report.memory
        ],
        "files": [str(each) for each in report.files],
        "unparsed": report.unparsed,
    }


def _place(told: Any) -> dict[str, Any]:
    place = told.place
    return {"file": str(place.file), "line": place.line or None, "column": place.column or None}
