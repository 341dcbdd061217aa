"""`cfepy run`: run a mission piece by piece, keep the display up to date, and report.

The pieces change nothing in the run. They are there so that Ctrl-C ends it between two of them, cleanly, and so that
the status line moves. A second Ctrl-C interrupts the task that is running, should the first one not be enough.
"""

from __future__ import annotations

import argparse
import contextlib
import gc
import json
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

from cfepy.cli import report
from cfepy.cli.display import Display, make_display
from cfepy.cli.main import BAD_USAGE, ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.trace_file import TraceFile
from cfepy.console import Console
from cfepy.mission import Mission, MissionSpec, read_mission
from cfepy.mission.results import Mark, Results, mark
from cfepy.rtos.policy import SeededRandom
from cfepy.rtos.realtime import NS_PER_S, Pacer, Stopwatch
from cfepy.status import CfeError, UsageError

FIRST_PIECE_NS = 10_000_000
LEAST_PIECE_NS = 1_000_000
SHORT_NS, LONG_NS = 80_000_000, 250_000_000  # wall time that a piece should take


def run(arguments: argparse.Namespace) -> int:
    """Run the mission that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: it cannot run like this.
    """
    spec = read_mission(arguments.mission)
    numbers = _output(arguments.json)
    try:
        flight = _fly(arguments, spec)
    except CfeError as error:
        print(f"cfepy: {spec.script}: the mission cannot boot: {error}", file=sys.stderr)
        return BAD_USAGE
    results = Results.of(flight.mission, flight.at, flight.trace)
    if numbers is not None:
        numbers.write_text(json.dumps(results.to_dict(), indent=2) + "\n", encoding="utf-8")
    report.show(results, sys.stdout)
    _explain(results, arguments, flight.interrupts.asked)
    print(f"trace: {results.trace}")
    return _status(results, flight.interrupts.asked)


class Flight:
    """A run that goes on until its time is over, or until somebody presses Ctrl-C.

    Args:
        mission: the mission.
        arguments: of the command line.
        display: is told between the pieces.
        interrupts: says whether somebody pressed Ctrl-C.
    """

    def __init__(
        self, mission: Mission, arguments: argparse.Namespace, display: Display, interrupts: Interrupts
    ) -> None:
        self.mission = mission
        self.interrupts = interrupts
        self.trace = ""
        self.at: Mark
        self._display = display
        self._until_ns = round(arguments.seconds * NS_PER_S)
        self._piece_ns = FIRST_PIECE_NS
        self._step: Callable[[int], None] = self._free_step
        if arguments.realtime is not None:
            self._step = Pacer(mission.kernel, mission.run_until, arguments.realtime).step

    def go(self) -> None:
        """Run, let the nodes shut down, and take down what there is to know before the tasks end."""
        watch = Stopwatch()
        with _no_collection_between_pieces():
            try:
                while self._goes_on():
                    self._step(self._until_ns)
                    self._display.update(self.mission)
                self.at = mark(self.mission, watch.elapsed_ns())
                self.mission.shut_down_nodes()
            except KeyboardInterrupt:
                self.at = mark(self.mission, watch.elapsed_ns())
        self.trace = self.mission.trace.digest()

    def _goes_on(self) -> bool:
        mission = self.mission
        return mission.kernel.now < self._until_ns and mission.reset_reason is None and not self.interrupts.asked

    def _free_step(self, until_ns: int) -> None:
        """As fast as it goes: a piece of virtual time that takes some 80 to 250 ms of wall time."""
        watch = Stopwatch()
        self.mission.run_until(min(until_ns, self.mission.kernel.now + self._piece_ns))
        wall_ns = watch.elapsed_ns()
        if wall_ns < SHORT_NS:
            self._piece_ns *= 2
        elif wall_ns > LONG_NS:
            self._piece_ns = max(LEAST_PIECE_NS, self._piece_ns // 2)


class Interrupts:
    """What Ctrl-C does while a mission runs and ends; use as a context manager.

    The first one sets `asked`, for the run to end at the next occasion. The second one raises KeyboardInterrupt, for a
    task that gives no occasion. Any more are ignored: they would disturb the ending of tasks.
    """

    def __init__(self) -> None:
        self.asked = False
        self._count = 0
        self._before: Any = None

    def __enter__(self) -> Interrupts:
        try:
            self._before = signal.signal(signal.SIGINT, self._on_signal)
        except ValueError:
            pass  # not the main thread: Ctrl-C does not come here
        return self

    def __exit__(self, *error: object) -> None:
        if self._before is not None:
            signal.signal(signal.SIGINT, self._before)

    def _on_signal(self, *_: object) -> None:
        self.asked = True
        self._count += 1
        if self._count == 2:
            raise KeyboardInterrupt


@contextlib.contextmanager
def _no_collection_between_pieces() -> Iterator[None]:
    """The kernel collects garbage at fixed virtual times; in the host it would run finalizers at the clock's whim."""
    enabled = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if enabled:
            gc.enable()


def _fly(arguments: argparse.Namespace, spec: MissionSpec) -> Flight:
    with contextlib.ExitStack() as stack:
        interrupts = stack.enter_context(Interrupts())
        trace = stack.enter_context(TraceFile(arguments.trace)) if arguments.trace else None
        display = make_display(arguments.quiet, arguments.seconds)
        stack.callback(display.close)
        mission = stack.enter_context(_mission(arguments, spec, display, trace))
        flight = Flight(mission, arguments, display, interrupts)
        flight.go()
    return flight


def _mission(arguments: argparse.Namespace, spec: MissionSpec, display: Display, trace: TraceFile | None) -> Mission:
    console = Console(sink=display.line if trace is None else trace.console_sink(display.line))
    try:
        mission = Mission(
            spec,
            seed=arguments.seed,
            board=arguments.board,
            tasks=arguments.tasks,
            console=console,
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


def _explain(results: Results, arguments: argparse.Namespace, interrupted: bool) -> None:
    sys.stdout.flush()
    for problem in (*results.script_problems, *results.problems):
        print(f"cfepy: {problem}", file=sys.stderr)
    if results.script_problems:
        print(f'cfepy: "cfepy check {arguments.mission}" says what is wrong with the mission', file=sys.stderr)
    if interrupted:
        print(f"cfepy: ended by Ctrl-C after {results.virtual_s:g} virtual seconds", file=sys.stderr)
    elif results.booted_s is None and results.reset is None:
        text = f"not OPERATIONAL after {results.virtual_s:g} virtual seconds; run it for longer (--for)"
        print(f"cfepy: {text}", file=sys.stderr)


def _status(results: Results, interrupted: bool) -> int:
    if interrupted:
        return INTERRUPTED
    if results.script_problems or results.problems:
        return FOUND_PROBLEMS
    return ENDED_WELL if results.booted_s is not None else BAD_USAGE
