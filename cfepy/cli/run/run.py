"""`cfepy run`, and its common part with launch, node and replay: flying a plan, and reporting the run."""

from __future__ import annotations

import argparse
import sys
from collections.abc import Sequence
from typing import TYPE_CHECKING

from cfepy.cli.display import Display, make_display
from cfepy.cli.flight_add_ons import FlightAddOns
from cfepy.cli.flight_options import check_pace
from cfepy.cli.main import BAD_USAGE, ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.options import plan_of_mission
from cfepy.cli.run import report
from cfepy.cli.run.outputs import Outputs, recording
from cfepy.cli.text_table import Table, show_tables
from cfepy.cli.user_notes import note, tell
from cfepy.cli.watched_host import Interrupts, WatchedHost
from cfepy.pilot import Flown, RunPlan, fly
from cfepy.trace import TimedRecords, Trace

if TYPE_CHECKING:
    from cfepy.journal import Replay


_STATUSES = {
    report.PASSED: ENDED_WELL,
    report.FAILED: FOUND_PROBLEMS,
    report.INCONCLUSIVE: BAD_USAGE,
    report.INTERRUPTED: INTERRUPTED,
}


class View:
    """The view of a run: the flight computer's console, and a full report.

    Args:
        arguments: the command line with the options of `add_outputs`.

    Attributes:
        tables: tables of add-ons for the end of the report.
    """

    longer = "run it for longer (--for)"

    def __init__(self, arguments: argparse.Namespace) -> None:
        self.arguments = arguments
        self.quiet: bool = arguments.quiet
        self.hides_console: bool = arguments.quiet or arguments.no_console
        self.tables: Sequence[Table] = ()

    def display(self, seconds: float) -> Display:
        """Make the display of the console during a run of so many virtual seconds."""
        return make_display(self.hides_console, seconds)

    def report(self, flown: Flown) -> None:
        """Print the results of the run."""
        report.show(flown.results, sys.stdout)

    def end(self, flown: Flown, outputs: Outputs, longer: str) -> int:
        """Print the report and all messages after a run; if quiet, only the problems, the doubts and the verdict.

        Args:
            flown: the run.
            outputs: saves the mission's files.
            longer: advice for a run that was too short.

        Returns:
            The exit status.
        """
        if self.quiet:
            print("".join(f"{line}\n" for line in report.failed_steps(flown)), end="")
            tell((*told_problems(flown), *flown.results.never_happened))
            outputs.save_files(flown, quiet=True)
        else:
            self.report(flown)
            show_tables(self.tables, sys.stdout)
            if flown.outcome is not None:
                print(f"\n{flown.outcome.text()}")
            _explain(flown)
            outputs.save_files(flown)
            print(f"trace: {flown.trace or 'none, since the run was broken off'}")
        _explain_end(flown, longer)
        print(report.verdict_line(flown), flush=True)
        return status_of(flown)


def run(arguments: argparse.Namespace) -> int:
    """Run the mission that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: the options do not allow the run.
    """
    return fly_and_tell(arguments, plan_of_mission(arguments), View(arguments))


def fly_and_tell(arguments: argparse.Namespace, plan: RunPlan, view: View) -> int:
    """Fly a plan as the command line asks, and report; or compare several runs of it.

    Args:
        arguments: the command line with the options of `add_flight`.
        plan: the run.
        view: shows the run.

    Returns:
        The exit status.

    Raises:
        UsageError: the options do not allow the run.
    """
    check_pace(arguments)
    report.load_add_ons()
    if arguments.check_determinism is not None:
        from cfepy.cli.run.check_determinism import check

        return check(arguments, plan)
    with recording(arguments, plan) as journal, Interrupts() as interrupts, Outputs(arguments, plan) as outputs:
        spec = plan.spec()  # inside the context, so that the journal has the files that are read here
        with (
            FlightAddOns(arguments, spec.name, note) as add_ons,
            WatchedHost(
                interrupts,
                view.display,
                realtime=arguments.realtime,
                ports=dict(arguments.port),
                add_ons=add_ons,
                pause=_nothing if journal is None else journal.mark,
            ) as host,
        ):
            flown = fly(
                plan,
                spec=spec,
                attachments=[*outputs.attachments, *add_ons.attachments, *([] if journal is None else [journal])],
                console=host.console,
                policy=None if journal is None else journal.policy,
                trace=outputs.trace,
                host=host,
            )
            if journal is not None:
                journal.end(flown)
            view.tables = add_ons.tables(flown)
    return _tell(flown, outputs, view, view.longer)


def fly_again(arguments: argparse.Namespace, replay: Replay, view: View) -> int:
    """Repeat the run of a journal as the command line asks, and report.

    Args:
        arguments: the command line with the options of `add_outputs`.
        replay: the replay; it has a verdict afterwards.
        view: shows the run.

    Returns:
        The exit status of the run.

    Raises:
        UsageError: it cannot run.
    """
    plan = replay.journal.plan  # with the paths that the run had
    with (
        Interrupts() as interrupts,
        Outputs(arguments, plan) as outputs,
        WatchedHost(interrupts, view.display) as host,
    ):
        trace = outputs.trace or Trace(records=TimedRecords())
        flown = replay.fly(outputs.attachments, console=host.console, trace=trace, host=host)
    return _tell(flown, outputs, view, replay.why_over)


def _tell(flown: Flown, outputs: Outputs, view: View, longer: str) -> int:
    unwritten = outputs.write_findings(flown)
    status = view.end(flown, outputs, longer)
    if unwritten is not None:
        raise unwritten
    return status


def _nothing() -> None:
    """Do nothing between two steps of a run that is not recorded."""


def _explain(flown: Flown) -> None:
    results = flown.results
    tell((*told_problems(flown), *results.never_happened, *results.loose_ends, *results.traps))
    if results.script_problems:
        script = flown.mission.spec.script
        tell([f'the console output shows the reason; "cfepy check {script}" checks the mission without running it'])


def _explain_end(flown: Flown, longer: str) -> None:
    """Report why a run ended before its time, or was too short."""
    results, mission = flown.results, flown.mission
    if flown.interrupted:
        tell([f"ended by Ctrl-C or SIGTERM after {results.virtual_s:g} virtual seconds"])
    elif results.booted_s is None and not mission.over and flown.stall is None:
        tell([f"not OPERATIONAL after {results.virtual_s:g} virtual seconds; {longer}"])


def told_problems(flown: Flown) -> list[str]:
    """Return the problems, a line each, except steps of the script, which have a report of their own."""
    return [problem.text for problem in flown.problems if not problem.is_step]


def status_of(flown: Flown) -> int:
    """Return the exit status of a command that flew a mission; problems decide it, if there are any."""
    return _STATUSES[report.outcome_of(flown)]
