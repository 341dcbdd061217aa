"""`cfepy run`: run a mission piece by piece, keep the display up to date, and report.

The pieces change nothing in the run. They are there so that Ctrl-C ends it between two of them, cleanly, and the
status line moves. A second Ctrl-C interrupts the task that is running, should the first one not be enough.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import signal
import sys
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

from cfepy.cli.display import Display, make_display
from cfepy.cli.main import BAD_USAGE, ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.trace_file import TraceFile
from cfepy.console import Console
from cfepy.mission import Mission, read_mission
from cfepy.rtos.policy import Policy, SeededRandom
from cfepy.rtos.realtime import NS_PER_S, Pacer, Stopwatch
from cfepy.status import CfeError, UsageError

if TYPE_CHECKING:
    from cfepy.mission.results import Mark, Results

FIRST_PIECE_NS = 10_000_000
SHORT_NS, LONG_NS = 25_000_000, 60_000_000  # wall time that a piece should take


def run(arguments: argparse.Namespace) -> int:
    """Run the mission that the command line names; the exit status.

    Raises:
        UsageError: it cannot run like this.
    """
    spec = read_mission(arguments.mission)
    with contextlib.ExitStack() as stack:
        trace = stack.enter_context(TraceFile(arguments.trace)) if arguments.trace else None
        display = make_display(arguments.quiet, arguments.seconds)
        stack.callback(display.close)
        mission = stack.enter_context(_make(arguments, spec, display, trace))
        interrupted = _run(arguments, mission, display)
        at = interrupted.mark
    return _finish(arguments, mission, at, interrupted.by_signal)


def _make(arguments: argparse.Namespace, spec: Any, display: Display, trace: TraceFile | None) -> Mission:
    policy: Policy | None = SeededRandom(arguments.seed) if arguments.schedule == "random" else None
    console = Console(sink=display.line if trace is None else trace.console_sink(display.line))
    try:
        mission = Mission(
            spec,
            seed=arguments.seed,
            board=arguments.board,
            tasks=arguments.tasks,
            console=console,
            policy=policy,
            trace_sink=None if trace is None else trace.write,
        )
    except UsageError:
        raise
    except ValueError as error:  # a task context that is not installed
        raise UsageError(str(error), field="--tasks") from None
    if trace is not None:
        trace.watch(mission)
    return mission
