"""`--junit FILE`, `--sarif FILE` and `--github`: the findings of a command for continuous integration.

A command makes a `Suite` of test cases and a list of findings. The options are in `cfepy.cli.options.add_ci_outputs`.
"""

from __future__ import annotations

import argparse
import os
import sys
from collections.abc import Iterable, Mapping, Sequence
from pathlib import Path

from cfepy import __version__
from cfepy.cli.json_output import json_text, write_text
from cfepy.status import UsageError
from cfepy.writing.ci_findings import CiFinding, FindingPlace, annotation_lines
from cfepy.writing.junit import Suite
from cfepy.writing.sarif_log import SarifRule, sarif_log

REPOSITORY = "GITHUB_WORKSPACE"
"""Environment variable with the folder of the checked-out repository in a workflow of GitHub."""
USAGE_RULE = "usage"


def write_ci_outputs(
    arguments: argparse.Namespace, tool: str, suite: Suite, findings: Sequence[CiFinding], kinds: Mapping[str, str]
) -> None:
    """Write the outputs that the command line asks for.

    Args:
        arguments: the command line.
        tool: name of the command, such as `cfepy run`.
        suite: the test cases.
        findings: the findings.
        kinds: a sentence about each rule.

    Raises:
        UsageError: a file cannot be written.
    """
    base = top_folder()
    if arguments.github:
        print_annotations(findings, base)
    if arguments.junit is not None:
        write_text(arguments.junit, suite.xml(base).decode("utf-8"), "--junit", arguments)
    if arguments.sarif is not None:
        levels = {each.rule: each.level for each in findings}
        rules = [SarifRule(rule, kinds[rule], level=level) for rule, level in sorted(levels.items())]
        log = sarif_log(tool, __version__, rules, findings, base)
        write_text(arguments.sarif, json_text(log, 2) + "\n", "--sarif", arguments)


def print_annotations(findings: Iterable[CiFinding], base: Path) -> None:
    """Print findings as GitHub's annotations."""
    for each in findings:
        for line in annotation_lines(each, base):
            print(line)
    sys.stdout.flush()


def annotate(error: UsageError) -> None:
    """Print an error of the command line or of a file as GitHub's annotations."""
    findings = []
    for each in error.each:
        text = f"{each.field}: {each.text}" if each.field else each.text
        place = () if each.file is None else (FindingPlace(Path(each.file).absolute(), each.line or 0),)
        findings.append(CiFinding(USAGE_RULE, text, place))
    print_annotations(findings, top_folder())


def top_folder() -> Path:
    """Return the folder to which the files of findings are relative: the checked-out repository, or the working
    directory.
    """
    here = Path.cwd()
    given = os.environ.get(REPOSITORY)
    return Path(given) if given and here.is_relative_to(given) else here
