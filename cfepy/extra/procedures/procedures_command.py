"""`cfepy procedures`: flies procedures and reports their tests, racy tests, and requirements."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import Any

from cfepy.cli.ci_outputs import write_ci_outputs
from cfepy.cli.json_output import json_text, write_text
from cfepy.cli.options import plan_of
from cfepy.extra.procedures.flying_suites import (
    FAIL,
    PASS,
    CampaignResult,
    ProcedureResult,
    Settings,
    fly_procedures,
)
from cfepy.extra.procedures.matrix import campaign_data, changes_since, matrix_csv, matrix_page, summary_line
from cfepy.extra.procedures.procedure_errors import UnsupportedError
from cfepy.extra.procedures.procedure_loader import find_procedures
from cfepy.extra.procedures.racy_tests import Verdicts, explore_procedures
from cfepy.extra.procedures.requirements import STATES
from cfepy.extra.procedures.script_words import value_of
from cfepy.extra.procedures.station import CI_PORT, TO_PORT
from cfepy.status import UsageError
from cfepy.writing.ci_findings import CiFinding, FindingPlace
from cfepy.writing.junit import FAILURE, SKIPPED, Case, Problem, Suite

_LAST_EVENTS = 8
_HIGHEST_PORT = 65_535
RULE = {
    "failed-test": "a test of a procedure failed",
    "racy-test": "the verdict of a test depends on the schedule or on the ground station",
}
_OF_ONE_FLIGHT = ("json", "csv", "html", "baseline", "journals")


def run(arguments: argparse.Namespace) -> int:
    """Fly the procedures that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: for a mistake in the procedures, the mission or an option.
    """
    files = find_procedures(Path(arguments.procedures))
    settings = settings_of(arguments)
    try:
        if arguments.explore is not None:
            return _explore(files, settings, arguments)
        result = fly_procedures(files, settings, lambda each: _print_result(each, arguments.show_output))
    except UnsupportedError as error:
        raise UsageError(str(error), file=arguments.procedures) from None
    return _report(result, arguments)


def settings_of(arguments: argparse.Namespace) -> Settings:
    """Return the settings of a command line.

    Raises:
        UsageError: if an option is wrong.
    """
    variables = tuple(variable_of(each) for each in arguments.variables)
    return Settings(
        plan_of(arguments, [arguments.mission]),
        target=arguments.target,
        variables=variables,
        answers=None if arguments.answers is None else Path(arguments.answers),
        requirements=None if arguments.requirements is None else Path(arguments.requirements),
        definitions=tuple(Path(each).resolve() for each in arguments.definitions),
        tests=tuple(arguments.tests),
        through_lab=False if arguments.bus else None,
        udp=None if arguments.computer is None else place_of(arguments.computer),
        line_delay=arguments.line_delay,
        ground_seed=arguments.ground_seed,
        journals=None if arguments.journals is None else Path(arguments.journals),
    )


def variable_of(text: str) -> tuple[str, Any]:
    """Return name and value of NAME=VALUE.

    Raises:
        UsageError: if there is no "=".
    """
    name, equals, value = text.partition("=")
    if not equals:
        raise UsageError(f"expected NAME=VALUE, not {text!r}", field="--variable")
    known = {"true": True, "false": False}
    return name, known[value] if value in known else value_of(value)


def place_of(text: str) -> tuple[str, int, int]:
    """Return host, command port and telemetry port of HOST[:PORT[:PORT]].

    Raises:
        UsageError: there are more ports, or one is not a number from 1 to 65,535.
    """
    host, *words = text.split(":")
    ports = [int(each) if each.isdecimal() else 0 for each in words]
    if not host or len(ports) > 2 or not all(0 < each <= _HIGHEST_PORT for each in ports):
        expected = f"HOST[:PORT[:PORT]] with ports from 1 to {_HIGHEST_PORT:,}"
        raise UsageError(f"expected {expected}, not {text!r}", field="--computer")
    command_port, telemetry_port = (*ports, *(CI_PORT, TO_PORT)[len(ports) :])
    return host, command_port, telemetry_port


def _print_result(each: ProcedureResult, verbose: bool) -> None:
    print(f"{each.verdict} {each.full_name}  {each.seconds:.3f} s", flush=True)
    if each.verdict != PASS:
        print(f"  {each.place}{': ' if each.place else ''}{each.message}")
    if verbose or each.verdict == FAIL:
        for line in each.output:
            print(f"  | {line}")
    if each.verdict == FAIL and each.events:
        print("  the last events:")
        for line in each.events[-_LAST_EVENTS:]:
            print(f"    {line}")


def _report(result: CampaignResult, arguments: argparse.Namespace) -> int:
    for each in result.notes:
        print(f"note: {each}")
    wall, virtual = sum(each.wall for each in result.tests), sum(each.seconds for each in result.tests)
    print(f"{summary_line(result)}; {virtual:.1f} virtual s in {wall:.1f} s")
    data = campaign_data(result)
    changes = None if arguments.baseline is None else changes_since(Path(arguments.baseline), data)
    for line in changes or []:
        print(f"changed: {line}")
    if arguments.json is not None:
        write_text(arguments.json, json_text(data, 2) + "\n", "--json", arguments)
    if arguments.csv is not None:
        write_text(arguments.csv, matrix_csv(result.requirements), "--csv", arguments)
    if arguments.html is not None:
        page = matrix_page(result, f"Procedures of {arguments.mission}", changes)
        write_text(arguments.html, page, "--html", arguments)
    findings = [CiFinding("failed-test", f"{each.full_name}: {each.message}", _places(each)) for each in result.failed]
    write_ci_outputs(arguments, "cfepy procedures", junit_suite(result, arguments.mission), findings, RULE)
    return 1 if result.failed else 0


def junit_suite(result: CampaignResult, mission: str) -> Suite:
    """Return the tests as JUnit XML, with requirements as properties."""
    cases = []
    for each in result.tests:
        problems: tuple[Problem, ...] = ()
        if each.verdict != PASS:
            kind = FAILURE if each.verdict == FAIL else SKIPPED
            detail = "\n".join([*each.output, *each.events[-_LAST_EVENTS:]])
            problems = (Problem(kind, each.message or "skipped", detail=detail),)
        named = {"requirement": ", ".join(each.requirements)} if each.requirements else {}
        cases.append(Case(each.suite, each.name, each.seconds, problems, _place(each), named))
    states = {f"requirement {each.name}": STATES[each.state] for each in result.requirements.rows()}
    return Suite(f"cfepy procedures {mission}", cases, states)


def _place(each: ProcedureResult) -> FindingPlace | None:
    file, _, line = each.place.rpartition(":")
    return FindingPlace(Path(file), int(line)) if file else None


def _places(each: ProcedureResult) -> tuple[FindingPlace, ...]:
    place = _place(each)
    return () if place is None else (place,)


def _explore(files: Sequence[Path], settings: Settings, arguments: argparse.Namespace) -> int:
    for name in _OF_ONE_FLIGHT:
        if getattr(arguments, name) is not None:
            raise UsageError("is about one flight; leave it out, or fly without --explore", field=f"--{name}")
    found = explore_procedures(files, settings, arguments.explore, print)
    racy = [each for each in found if each.is_racy]
    always = [each for each in found if each.failed and not each.passed]
    print(f"{len(found)} tests under {arguments.explore} schedules: {len(racy)} racy, {len(always)} always failed")
    _write_explored(found, arguments)
    for each in racy:
        _print_racy(each)
    for each in always:
        assert each.first is not None
        print(f"always failed: {each.name}: {each.first.message}")
    return 1 if racy or always else 0


def _write_explored(found: Sequence[Verdicts], arguments: argparse.Namespace) -> None:
    cases, findings = [], []
    for each in found:
        suite, _, name = each.name.partition("::")
        if each.first is None:
            cases.append(Case(suite, name, 0.0))
            continue
        rule = "racy-test" if each.is_racy else "failed-test"
        counts = f"{each.passed} passed, {each.failed} failed"
        text = f"{each.first.message}; {each.cause}" if each.is_racy else each.first.message
        problem = Problem(FAILURE, f"{rule.replace('-', ' ')}: {counts}: {text}")
        cases.append(Case(suite, name, each.first.seconds, (problem,), _place(each.first)))
        findings.append(CiFinding(rule, f"{each.name}: {counts}: {text}", _places(each.first)))
    suite_of_all = Suite(f"cfepy procedures {arguments.mission}", cases, {"schedules": str(arguments.explore)})
    write_ci_outputs(arguments, "cfepy procedures", suite_of_all, findings, RULE)


def _print_racy(each: Verdicts) -> None:
    assert each.first is not None
    print(f"racy: {each.name}: {each.passed} passed, {each.failed} failed")
    options = f"--schedule {each.schedule} --ground-seed {each.ground_seed}"
    print(f"  first with {options}, {each.first.place}: {each.first.message}")
    print(f"  cause: {each.cause}")
