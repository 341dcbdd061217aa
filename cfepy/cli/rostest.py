"""`cfepy rostest`: run the tests of a launch file, each with the file's nodes in a mission of its own."""

from __future__ import annotations

import argparse
import os
import sys
import tempfile
from dataclasses import replace
from pathlib import Path
from typing import Any

from cfepy.cli.display import PlainDisplay, SilentDisplay
from cfepy.cli.failures import booting, writing
from cfepy.cli.flight import Flight, Interrupts
from cfepy.cli.junit import FAILURE, TestResults, broken, read_results
from cfepy.cli.main import ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.ros_view import NodesDisplay
from cfepy.cli.run import fly
from cfepy.mission.course import BOOT_S
from cfepy.mission.launch import launch_file, plan_of, spec_of
from cfepy.rtos.units import NS_PER_S
from cfepy.status import UsageError

BOARD = "workstation"  # where the calls of nodes take time, as tests of nodes that never rest expect
LAST_LINES = 25  # of what a test printed, when it leaves no results


def run(arguments: argparse.Namespace) -> int:
    """Run the tests of the launch file that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: there is no such file, something in it is wrong, or it has no test.
    """
    file, args = launch_file(arguments.words)
    with tempfile.TemporaryDirectory() as folder, Interrupts() as interrupts:
        plan = plan_of(file, args, dict(os.environ), cwd=Path.cwd(), results=Path(folder))
        if not plan.tests:
            raise UsageError("has no <test>; `cfepy launch` runs what it has", file=file)
        for note in plan.notes:
            print(f"cfepy: {note}", file=sys.stderr)
        results = TestResults()
        for test in plan.tests:
            if not interrupts.asked:
                results.add(_Runner(file, plan, arguments, interrupts).run(test))
    print(results.text())
    if arguments.results_file is not None:
        with writing(arguments.results_file, "--results-file"):
            Path(arguments.results_file).write_bytes(results.xml(file.stem))
    if interrupts.asked:
        return INTERRUPTED
    return ENDED_WELL if results.passed else FOUND_PROBLEMS


class _Runner:
    """Runs the tests of one file.

    Args:
        file: the launch file.
        plan: what is in it (`rospy_shim.roslaunch.plan.Plan`).
        arguments: of the command line.
        interrupts: says whether somebody pressed Ctrl-C.
    """

    def __init__(self, file: Path, plan: Any, arguments: argparse.Namespace, interrupts: Interrupts) -> None:
        self._file = file
        self._plan = plan
        self._arguments = arguments
        self._interrupts = interrupts

    def run(self, test: Any) -> TestResults:
        """Run a test (`rospy_shim.roslaunch.plan.PlannedTest`), again and again as long as it fails and may."""
        results = self._once(test)
        for _ in range(test.retry):
            if results.passed or self._interrupts.asked:
                break
            test.results.unlink(missing_ok=True)
            results = self._once(test)
        return results

    def _once(self, test: Any) -> TestResults:
        suite = f"{test.package}.{test.test_name}"
        if test.node is None:
            return broken(suite, "can_run_here", test.problem)
        nodes = {**self._plan.nodes, test.node.app: test.node}
        spec = replace(spec_of(self._file, nodes, self._plan.params), board=BOARD)
        seconds = test.time_limit_ns / NS_PER_S
        arguments = argparse.Namespace(**{**vars(self._arguments), "seconds": seconds + BOOT_S})
        display = NodesDisplay(PlainDisplay(sys.stdout)) if self._arguments.text else SilentDisplay()
        with booting(self._file):
            flight = fly(arguments, spec, self._interrupts, None, None, lambda quiet, seconds: display)
        return self._judged(test, suite, flight, seconds)

    def _judged(self, test: Any, suite: str, flight: Flight, seconds: float) -> TestResults:
        """What the test wrote; without that, why it wrote nothing."""
        ros = flight.mission.ros
        ended = ros is not None and test.node.app in ros.monitor.statuses
        if not ended:
            text = f"did not end in its {seconds:g} virtual seconds; give it more (time-limit), or look why"
            return broken(suite, "time_limit", f"{text}{_last_lines(test, flight)}", FAILURE)
        try:
            return read_results(test.results, suite)
        except (OSError, ValueError) as error:
            why = "wrote no results" if isinstance(error, OSError) else f"wrote results that cannot be read: {error}"
            status = ros.monitor.statuses[test.node.app]
            return broken(suite, "test_ran", f"the test node {why}, exit status {status}{_last_lines(test, flight)}")


def _last_lines(test: Any, flight: Flight) -> str:
    """The end of what the test node printed."""
    begins = f"[{test.node.name}] "
    lines = [line.removeprefix(begins) for line in flight.mission.console.lines if line.startswith(begins)]
    return "".join(f"\n| {line}" for line in lines[-LAST_LINES:])
