"""`cfepy run`: run a mission as the command line says, and report what happened."""

from __future__ import annotations

import argparse
import contextlib
import json
import sys
from pathlib import Path

from cfepy.cli import report
from cfepy.cli.display import Display, make_display
from cfepy.cli.flight import Flight, Interrupts
from cfepy.cli.main import BAD_USAGE, ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.trace_file import TraceFile
from cfepy.console import Console
from cfepy.mission import Mission, MissionSpec, read_mission
from cfepy.mission.results import Results
from cfepy.rtos.policy import SeededRandom
from cfepy.status import CfeError, UsageError


def run(arguments: argparse.Namespace) -> int:
    """Run the mission that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: it cannot run like this.
    """
    with Interrupts() as interrupts:
        return _run(arguments, interrupts)


def _run(arguments: argparse.Namespace, interrupts: Interrupts) -> int:
    spec = read_mission(arguments.mission)
    numbers = _output(arguments.json)
    try:
        flight = _fly(arguments, spec, interrupts)
    except CfeError as error:
        print(f"cfepy: {spec.script}: the mission cannot boot: {error}", file=sys.stderr)
        return BAD_USAGE
    results = Results.of(flight.mission, flight.at, flight.trace)
    unwritten = None if numbers is None else _write(numbers, results)
    report.show(results, sys.stdout)
    _explain(results, arguments, interrupts.asked)
    print(f"trace: {results.trace}", flush=True)
    if unwritten is not None:
        raise unwritten
    return _status(results, interrupts.asked)


def _fly(arguments: argparse.Namespace, spec: MissionSpec, interrupts: Interrupts) -> Flight:
    flight: Flight | None = None
    try:
        with contextlib.ExitStack() as stack:
            trace = stack.enter_context(TraceFile(arguments.trace)) if arguments.trace else None
            display = make_display(arguments.quiet, arguments.seconds)
            stack.callback(display.close)
            mission = stack.enter_context(_mission(arguments, spec, display, trace))
            flight = Flight(mission, arguments.seconds, arguments.realtime, display, interrupts)
            flight.go()
    except KeyboardInterrupt:
        if flight is None or not flight.trace:
            raise
        # A task would not end; the process ends it, and the numbers are there.
    return flight


def _mission(arguments: argparse.Namespace, spec: MissionSpec, display: Display, trace: TraceFile | None) -> Mission:
    try:
        mission = Mission(
            spec,
            seed=arguments.seed,
            board=arguments.board,
            tasks=arguments.tasks,
            console=Console(sink=display.line),
            policy=SeededRandom(arguments.seed) if arguments.schedule == "random" else None,
            trace_sink=None if trace is None else trace.write,
        )
    except UsageError:
        raise
    except ValueError as error:  # a task context that is not installed
        raise UsageError(str(error), field="--tasks") from None
    if trace is not None:
        trace.watch(mission)
    return mission


def _output(file: str | None) -> Path | None:
    """The path for the numbers; that it can be written is better known before the run than after it."""
    if file is None:
        return None
    path = Path(file)
    try:
        path.open("a").close()
    except OSError as error:
        raise UsageError(f"cannot be written: {error.strerror}", file=file, field="--json") from None
    return path


def _write(file: Path, results: Results) -> UsageError | None:
    """Write the numbers; an error is returned, for the report of a long run must not be lost with them."""
    try:
        file.write_text(json.dumps(results.to_dict(), indent=2) + "\n", encoding="utf-8")
    except OSError as error:
        return UsageError(f"could not be written: {error.strerror}", file=str(file), field="--json")
    return None


def _explain(results: Results, arguments: argparse.Namespace, interrupted: bool) -> None:
    sys.stdout.flush()
    for problem in (*results.script_problems, *results.problems):
        print(f"cfepy: {problem}", file=sys.stderr)
    if results.script_problems:
        print(f'cfepy: "cfepy check {arguments.mission}" says what is wrong with the mission', file=sys.stderr)
    if interrupted:
        print(f"cfepy: ended by Ctrl-C after {results.virtual_s:g} virtual seconds", file=sys.stderr)
    elif results.booted_s is None:
        text = f"not OPERATIONAL after {results.virtual_s:g} virtual seconds; run it for longer (--for)"
        print(f"cfepy: {text}", file=sys.stderr)


def _status(results: Results, interrupted: bool) -> int:
    if interrupted:
        return INTERRUPTED
    if results.script_problems or results.problems:
        return FOUND_PROBLEMS
    return ENDED_WELL if results.booted_s is not None else BAD_USAGE
