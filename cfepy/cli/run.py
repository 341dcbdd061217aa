"""`cfepy run`: run a mission as the command line says, and report what happened."""

from __future__ import annotations

import argparse
import contextlib
import sys
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from cfepy.attachment import Attachment, Recorder
from cfepy.cli import report
from cfepy.cli.arguments import LONGEST_S
from cfepy.cli.display import Display, make_display
from cfepy.cli.failures import booting, writing
from cfepy.cli.flight import Flight, Interrupts, no_collection
from cfepy.cli.main import BAD_USAGE, ENDED_WELL, FOUND_PROBLEMS, INTERRUPTED
from cfepy.cli.recording import plan_of, recording
from cfepy.cli.saved_files import save_files, saving_to
from cfepy.console import Console
from cfepy.mission import Mission, MissionSpec
from cfepy.mission.course import Course, duration
from cfepy.mission.results import Results
from cfepy.rtos.policy import Policy
from cfepy.rtos.schedule import Schedule
from cfepy.status import UsageError

if TYPE_CHECKING:
    from cfepy.io.host_network import HostNetwork
    from cfepy.journal.recorder import JournalRecorder
    from cfepy.journal.replay import Replay
    from cfepy.mission.bag import BagRecorder
    from cfepy.mission.script import ScriptRun
    from cfepy.mission.script_verdicts import Outcome
    from cfepy.trace import Trace


class View:
    """What a person sees of a run: the flight computer's console, and a report of all that is on it."""

    def display(self, quiet: bool, seconds: float) -> Display:
        """What shows the console; see `make_display`."""
        return make_display(quiet, seconds)

    def report(self, results: Results, mission: Mission, stream: TextIO) -> None:
        """Print what the run came to."""
        report.show(results, stream)


def run(arguments: argparse.Namespace) -> int:
    """Run the mission that the command line names.

    Returns:
        The exit status.

    Raises:
        UsageError: it cannot run like this.
    """
    if arguments.check_determinism is not None:
        if arguments.play or arguments.bag:
            raise UsageError("runs that are compared play and record no bag", field="--check-determinism")
        from cfepy.cli.check_determinism import check

        return check(arguments)
    if arguments.port and arguments.realtime is None:
        raise UsageError("without --realtime no port is opened on this computer", field="--port")
    with recording(arguments, [arguments.mission]) as journal:
        return run_spec(arguments, plan_of(arguments, [arguments.mission]).spec(), journal=journal)


def run_spec(
    arguments: argparse.Namespace,
    spec: MissionSpec,
    view: View | None = None,
    journal: JournalRecorder | None = None,
    replay: Replay | None = None,
) -> int:
    """Run a mission as the command line says, and report.

    Args:
        arguments: of the command line.
        spec: the mission.
        view: what is shown of it; None shows the flight computer.
        journal: writes it down.
        replay: makes it the run of a journal.

    Returns:
        The exit status.

    Raises:
        UsageError: it cannot run like this.
    """
    for note in spec.notes:
        print(f"cfepy: {note}", file=sys.stderr, flush=True)
    with Interrupts() as interrupts:
        return _run(arguments, spec, interrupts, view or View(), journal, replay)


def _run(
    arguments: argparse.Namespace,
    spec: MissionSpec,
    interrupts: Interrupts,
    view: View,
    journal: JournalRecorder | None,
    replay: Replay | None,
) -> int:
    numbers = output_path(arguments.json)
    folder = saving_to(arguments.save_files)
    script = script_of(arguments, spec)
    recorder = trace_file(arguments.trace) if arguments.trace else None
    bag = _bag(arguments)
    with booting(spec.script):
        flight = fly(arguments, spec, interrupts, script, recorder, view.display, bag, journal, replay)
    results = Results.of(flight.mission, flight.at, flight.trace)
    if journal is not None:
        journal.end(results, flight.outcome, flight.reason)
    if replay is not None:
        replay.compare(results)
    unwritten = None if numbers is None else write_numbers(numbers, results, flight.outcome)
    view.report(results, flight.mission, sys.stdout)
    if flight.outcome is not None:
        print(f"\n{flight.outcome.text()}")
    longer = "run it for longer (--for)" if replay is None else replay.why_over
    _explain(results, flight.mission, interrupts.asked, longer)
    if folder is not None:
        save_files(flight.mission.files, folder)
    print(f"trace: {results.trace}", flush=True)
    if unwritten is not None:
        raise unwritten
    return _status(results, flight.mission, interrupts.asked, flight.outcome)


def script_of(arguments: argparse.Namespace, spec: MissionSpec) -> ScriptRun | None:
    """The script that the command line names; only a run with one imports what it needs."""
    if arguments.script is None:
        return None
    from cfepy.mission.script import ScriptRun

    return ScriptRun.read(arguments.script, spec, arguments.stop_on_failure)


def _bag(arguments: argparse.Namespace) -> BagRecorder | None:
    """What records topics; only a run with a bag imports it."""
    if arguments.bag is None:
        if arguments.bag_topics:
            raise UsageError("says what goes into a bag; give the bag, too: --bag FILE", field="--bag-topics")
        return None
    from cfepy.mission.bag import BagRecorder

    return BagRecorder(arguments.bag, arguments.bag_topics)


def trace_file(file: str) -> Recorder:
    from cfepy.cli.trace_file import TraceFile

    return TraceFile(file)


def _duration(arguments: argparse.Namespace, script: ScriptRun | None) -> float:
    """Virtual seconds that the run takes; with a script, at most; a paced one goes on until Ctrl-C."""
    if arguments.seconds is None and script is None and arguments.realtime is not None:
        return LONGEST_S
    return duration(arguments.seconds, script)


def fly(
    arguments: argparse.Namespace,
    spec: MissionSpec,
    interrupts: Interrupts,
    script: ScriptRun | None,
    recorder: Recorder | None = None,
    show: Callable[[bool, float], Display] = make_display,
    bag: BagRecorder | None = None,
    journal: JournalRecorder | None = None,
    replay: Replay | None = None,
) -> Flight:
    """Run a mission to its end.

    Args:
        arguments: of the command line.
        spec: the mission.
        interrupts: says whether somebody pressed Ctrl-C.
        script: what is to happen on the way.
        recorder: takes the trace.
        show: makes what shows the run, as `make_display` does.
        bag: records ROS topics.
        journal: writes it down.
        replay: makes it the run of a journal.

    Raises:
        UsageError: it cannot run like this.
        CfeError: it does not boot.
    """
    seconds = _duration(arguments, script)
    flight: Flight | None = None
    try:
        with contextlib.ExitStack() as stack:
            stack.enter_context(no_collection())
            if recorder is not None:
                stack.enter_context(recorder)
            if bag is not None:
                stack.enter_context(bag)
            display = show(arguments.quiet, seconds)
            stack.callback(display.close)
            attachments: list[Attachment] = [each for each in (script, bag, recorder, journal) if each is not None]
            attachments += [] if replay is None else replay.attachments
            attachments += faults_of(arguments, spec)
            trace = None if recorder is None else recorder.trace
            policy = _policy(arguments, journal, replay)
            mission = stack.enter_context(_mission(arguments, spec, display, attachments, trace, policy))
            make_course = Course if replay is None else replay.make_course
            course = make_course(mission, seconds if script is None else arguments.seconds, script)
            bridge = None if arguments.realtime is None else stack.enter_context(_bridge(arguments, mission, display))
            pause = _nothing if journal is None else journal.mark
            flight = Flight(course, arguments.realtime, display, interrupts, bridge, pause)
            flight.go()
    except KeyboardInterrupt:
        if flight is None or not flight.trace:
            raise
        # A task would not end; the process ends it, and the numbers are there.
    return flight


def faults_of(arguments: argparse.Namespace, spec: MissionSpec) -> list[Attachment]:
    """What lets the faults happen that the command line asks for; only a run with some imports it."""
    if arguments.faults is None:
        return []
    from cfepy.mission.fault_check import check_plan
    from cfepy.mission.fault_plans import injector_of

    injector = injector_of(arguments.faults, spec)
    for problem in check_plan(injector.plan, spec):
        print(f"cfepy: {problem}", file=sys.stderr, flush=True)
    return [injector]


def _policy(arguments: argparse.Namespace, journal: JournalRecorder | None, replay: Replay | None) -> Policy | None:
    """Who goes first."""
    if replay is not None:
        return replay.policy
    return Schedule.parse(arguments.schedule, arguments.seed).policy() if journal is None else journal.policy


def _nothing() -> None:
    """What happens between two pieces of a run that nobody writes down."""


def _mission(
    arguments: argparse.Namespace,
    spec: MissionSpec,
    display: Display,
    attachments: Sequence[Attachment],
    trace: Trace | None,
    policy: Policy | None,
) -> Mission:
    try:
        return Mission(
            spec,
            seed=arguments.seed,
            board=arguments.board,
            tasks=arguments.tasks,
            console=Console(sink=display.line),
            policy=policy,
            trace=trace,
            attachments=attachments,
        )
    except UsageError:
        raise
    except ValueError as error:  # a task context that is not installed
        raise UsageError(str(error), field="--tasks") from None


def _bridge(arguments: argparse.Namespace, mission: Mission, display: Display) -> HostNetwork:
    """Real ports for the mission's; only a paced run has them, and only it imports what they need."""
    from cfepy.io.host_network import HostNetwork

    return HostNetwork(mission, dict(arguments.port), display.line)


def output_path(file: str | None) -> Path | None:
    """The path for the numbers; that it can be written is better known before the run than after it."""
    if file is None:
        return None
    path = Path(file)
    with writing(path, "--json"):
        path.open("a").close()
    return path


def write_numbers(file: Path, results: Results, outcome: Outcome | None) -> UsageError | None:
    """Write the numbers; an error is returned, for the report of a long run must not be lost with them."""
    import json

    numbers = results.to_dict()
    if outcome is not None:
        numbers["script"] = outcome.to_dict()
    try:
        file.write_text(json.dumps(numbers, indent=2) + "\n", encoding="utf-8")
    except OSError as error:
        return UsageError(f"could not be written: {error.strerror}", file=str(file), field="--json")
    return None


def tell_faults(results: Results) -> None:
    """Say which faults have never happened, and why."""
    for row in results.faults:
        if not row["times"]:
            print(f"cfepy: fault {row['name']} ({row['what']}) never happened: {row['never']}", file=sys.stderr)


def _explain(results: Results, mission: Mission, interrupted: bool, longer: str) -> None:
    sys.stdout.flush()
    for problem in (*results.script_problems, *results.problems):
        print(f"cfepy: {problem}", file=sys.stderr)
    tell_faults(results)
    if results.script_problems:
        text = f'the console says why, and "cfepy check {mission.spec.script}" what can be seen without running it'
        print(f"cfepy: {text}", file=sys.stderr)
    if interrupted:
        print(f"cfepy: ended by Ctrl-C or SIGTERM after {results.virtual_s:g} virtual seconds", file=sys.stderr)
    elif results.booted_s is None and not mission.over:
        text = f"not OPERATIONAL after {results.virtual_s:g} virtual seconds; {longer}"
        print(f"cfepy: {text}", file=sys.stderr)


def _status(results: Results, mission: Mission, interrupted: bool, outcome: Outcome | None) -> int:
    if interrupted:
        return INTERRUPTED
    if outcome is not None:
        return ENDED_WELL if outcome.ok else FOUND_PROBLEMS
    if results.script_problems or results.problems:
        return FOUND_PROBLEMS
    return ENDED_WELL if results.booted_s is not None or mission.over else BAD_USAGE
