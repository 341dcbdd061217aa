"""Flies procedures: a mission for each suite, its tests in order, with verdict, times, output and events of each."""

from __future__ import annotations

import contextlib
import io
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.attachment import Attachment
from cfepy.extra.procedures.answers import Answers
from cfepy.extra.procedures.connection import CfepyConnection, methods_of, test_classes
from cfepy.extra.procedures.definition_reader import ruby_variables
from cfepy.extra.procedures.pauses import AskedPauses, Pauses, line_of
from cfepy.extra.procedures.procedure_errors import SkipScript, StopScript, UnsupportedError
from cfepy.extra.procedures.procedure_loader import Procedures, group_output, has_second_door, suites_in
from cfepy.extra.procedures.requirements import Requirements, marked
from cfepy.extra.procedures.script_api import ScriptApi
from cfepy.extra.procedures.station import BusTelemetry, FlightStation, Station, UdpStation
from cfepy.extra.procedures.suites import ProcedureGroup, ProcedureStep, ProcedureSuite, is_suite, steps_of
from cfepy.extra.procedures.target_packets import TargetPackets
from cfepy.flight import Flight
from cfepy.ground import dictionary_of, topics_of
from cfepy.interpreter.host_system import command_line
from cfepy.journal import JournalRecorder
from cfepy.pilot import RunPlan
from cfepy.rtos import Policy, Stopwatch
from cfepy.schedules import Schedule
from cfepy.status import CfeError, UsageError
from cfepy.units import NS_PER_S

LINE_DELAY_S = 0.1
"""The pause before each line in COSMOS, if neither the user nor the procedure sets another one."""
PASS, FAIL, SKIP = "PASS", "FAIL", "SKIP"
PROCEDURES, TARGETS = "procedures", "targets"


@dataclass(frozen=True, slots=True)
class Settings:
    """How procedures fly.

    Attributes:
        plan: the mission and how it flies.
        target: name of the target; empty for the folder's or the mission's name.
        variables: variables of ERB.
        answers: file with answers to questions.
        requirements: file with texts of requirements.
        definitions: folders with `cmd_tlm` of targets, besides the one that the procedures are in.
        tests: only tests whose names contain one of these texts; all if it is empty.
        through_lab: whether commands and telemetry go through CI_LAB and TO_LAB; None if the mission has both.
        udp: address of a flight computer instead of a mission: host, command port, telemetry port.
        journals: folder for journals of suites with a failed test.
        line_delay: pause before each line of a procedure in s.
        ground_seed: seed of the ground station's start and delays; 0 for none.
    """

    plan: RunPlan
    target: str = ""
    variables: tuple[tuple[str, Any], ...] = ()
    answers: Path | None = None
    requirements: Path | None = None
    definitions: tuple[Path, ...] = ()
    tests: tuple[str, ...] = ()
    through_lab: bool | None = None
    udp: tuple[str, int, int] | None = None
    journals: Path | None = None
    line_delay: float = LINE_DELAY_S
    ground_seed: int = 0


@dataclass(slots=True)
class ProcedureResult:
    """The result of a test, a setup or a teardown.

    Attributes:
        suite: name of the suite, or of the script's file.
        name: group and method.
        verdict: PASS, FAIL or SKIP.
        message: why it did not pass.
        place: "FILE:LINE" of the procedure.
        seconds: virtual time in s.
        wall: wall time in s.
        output: lines that it printed.
        events: events of the flight computer meanwhile.
        requirements: ids that it shows.
        is_test: False for a setup or teardown.
        states: ids, states and messages of the requirements that it has set or shows.
    """

    suite: str
    name: str
    verdict: str = PASS
    message: str = ""
    place: str = ""
    seconds: float = 0.0
    wall: float = 0.0
    output: list[str] = field(default_factory=list)
    events: list[str] = field(default_factory=list)
    requirements: tuple[str, ...] = ()
    is_test: bool = True
    states: list[tuple[str, str, str]] = field(default_factory=list)

    @property
    def full_name(self) -> str:
        """The names of the suite, the group and the method."""
        return f"{self.suite}::{self.name}"


@dataclass(slots=True)
class CampaignResult:
    """The results of all suites, the requirements, and remarks."""

    tests: list[ProcedureResult] = field(default_factory=list)
    requirements: Requirements = field(default_factory=Requirements)
    notes: list[str] = field(default_factory=list)

    @property
    def failed(self) -> list[ProcedureResult]:
        """The tests, setups and teardowns that failed."""
        return [each for each in self.tests if each.verdict == FAIL]


def fly_procedures(
    files: Sequence[Path], settings: Settings, note: Callable[[ProcedureResult], object] = lambda result: None
) -> CampaignResult:
    """Fly files of procedures, each suite in a mission of its own.

    Args:
        files: the files.
        settings: how they fly.
        note: called with each result at once.

    Raises:
        UsageError: if a file, a definition or the mission has a mistake.
    """
    result = CampaignResult(requirements=Requirements(settings.requirements))
    for file in files:
        for suite in suites_in(file):
            with FlyingSuite(file, suite, settings, result.requirements) as flying:
                for step in flying.steps:
                    done = flying.run(step)
                    if done is not None:
                        result.tests.append(done)
                        note(done)
                result.notes += [each for each in flying.notes if each not in result.notes]
    return result


class Observed(NamedTuple):
    """How the flight of a racy test is observed; each of its pauses is a question to the policy.

    Attributes:
        policy: decides in place of the schedule's own.
        attachments: observers of the run.
    """

    policy: Policy
    attachments: Sequence[Attachment] = ()


class OfflineStation(Station):
    """A station without a flight, to find the tests of files."""

    @property
    def now(self) -> float:
        return 0.0

    def wait(self, seconds: float) -> None:
        raise UnsupportedError("a procedure with a suite must not wait outside of its methods")

    def _put(self, packet: bytes) -> None:
        raise UnsupportedError("a procedure with a suite must not send commands outside of its methods")


class FlyingSuite:
    """A suite in its mission; a context manager.

    Args:
        file: its file.
        suite: its name; empty for a script without one.
        settings: how it flies.
        requirements: where its tests write the states of requirements.
        offline: whether there is no mission, to find the tests only.
        observed: for the analysis of a racy test, how its flight is observed.

    Attributes:
        steps: its methods, in order.
        notes: remarks.
        flight: the mission; None on the network or without a flight.
        journal: the file of its journal, which is kept if a test fails; None without one.
    """

    def __init__(
        self,
        file: Path,
        suite: str,
        settings: Settings,
        requirements: Requirements,
        offline: bool = False,
        observed: Observed | None = None,
    ) -> None:
        self.steps: list[ProcedureStep] = []
        self.notes: list[str] = []
        self.flight: Flight | None = None
        self.journal: Path | None = None
        self._file, self._suite, self._settings = file, suite, settings
        self._requirements = requirements
        self._offline, self._observed = offline, observed
        self._lines: list[str] = []
        self._failed = False
        self._recorder: JournalRecorder | None = None
        self._stack = ExitStack()

    def __enter__(self) -> FlyingSuite:
        try:
            self._enter()
        except BaseException:
            self._stack.close()
            raise
        return self

    def _enter(self) -> None:
        spec = self._settings.plan.spec()
        target, folder = target_of(self._file, self._settings, spec.name)
        self._station = self._connected()
        dictionary = dictionary_of(spec) if self.flight is None else self.flight.dictionary
        self._targets = TargetPackets(dictionary, target)
        plugin = [] if folder is None else [folder, *list(folder.parents)[:2]]
        variables = {
            **ruby_variables(plugin),
            "target_name": target,
            "global_tlm_output_ip": "127.0.0.1",
            **dict(self._settings.variables),
        }
        for each in [*([] if folder is None else [folder]), *self._settings.definitions]:
            self._targets.read_folder(each, variables)
        self.notes += self._targets.notes
        line_delay = 0.0 if self._offline else self._settings.line_delay
        answers = Answers(self._settings.answers)
        self.api = ScriptApi(self._station, self._targets, answers, self._lines.append, line_delay)
        folders = [self._file.parent, *plugin, *(each / "lib" for each in plugin)]
        loader = Procedures(self.api, folders, variables, self._requirements)
        self._procedures = self._stack.enter_context(loader)
        self._stack.enter_context(group_output(self._lines.append))
        self._stack.callback(self._end_journal)
        self._stack.callback(self._read_trackers)
        self._load(target)

    def _connected(self) -> Station:
        if self._offline:
            return OfflineStation()
        if self._settings.udp is not None:
            station = UdpStation(*self._settings.udp)
            self._stack.callback(station.close)
            return station
        telemetry = BusTelemetry()
        plan = self._settings.plan
        attachments: list[Any] = [telemetry.watch]
        policy = plan.schedule.policy()
        if self._observed is not None:
            attachments += self._observed.attachments
            policy = self._observed.policy
        if self._settings.journals is not None:
            self._settings.journals.mkdir(parents=True, exist_ok=True)
            name = f"{self._file.stem}{'-' if self._suite else ''}{self._suite}"
            self.journal = self._settings.journals / f"{name}.cfepy"
            self._recorder = self._stack.enter_context(JournalRecorder(self.journal, plan, policy=policy))
            attachments.append(self._recorder)
            policy = self._recorder.policy
        self.flight = Flight(plan, policy=policy, attachments=attachments, again=self.command)
        self._stack.callback(self.flight.close)
        self.flight.run_until_operational()
        pauses = self._pauses(self.flight)
        self.flight.run_for(pauses.start())
        return FlightStation(self.flight, telemetry, self._settings.through_lab, pauses)

    def _pauses(self, flight: Flight) -> Pauses:
        seed = self._settings.ground_seed
        if self._observed is None or not seed:
            return Pauses(seed)
        kernel = flight.mission.kernel
        return AskedPauses(seed, kernel.answer, lambda: line_of(sys._getframe(1), self._procedures.files))

    def _read_trackers(self) -> None:
        self._requirements.current = self._suite or self._file.stem
        for each in self._procedures.trackers():
            self._requirements.read_tracker(each)

    def _end_journal(self) -> None:
        if self._recorder is None or self.flight is None or self.journal is None:
            return
        if self._failed:
            self._recorder.end(self.flight.flown())
        else:
            self._stack.callback(self.journal.unlink, missing_ok=True)

    def _load(self, target: str) -> None:
        if not self._suite and not has_second_door(self._file):
            self.steps = [ProcedureStep(self._file.stem, "", self._file.stem, lambda: self._procedures.run(self._file))]
            return
        try:
            with self._captured():
                names = self._procedures.run(self._file)
        except (UsageError, UnsupportedError):
            raise
        except Exception as error:
            place = self._procedures.place(error)
            raise UsageError(
                f"{type(error).__name__}: {error}{f' at {place}' if place else ''}", file=self._file
            ) from error
        if self._suite:
            kind = names[self._suite]
            assert is_suite(kind, ProcedureSuite)
            self.steps = [each for each in steps_of(kind) if self._is_wanted(each)]
            return
        for kind in test_classes(names):
            connection = CfepyConnection(self.api, target, kind)
            for name in methods_of(kind):
                call = getattr(connection.method_obj, name)
                step = ProcedureStep(self._file.stem, kind.__name__, name, call, (call.__doc__ or "").strip())
                if self._is_wanted(step):
                    self.steps.append(step)

    def _is_wanted(self, step: ProcedureStep) -> bool:
        wanted = self._settings.tests
        return not step.is_test or not wanted or any(each in f"{step.suite}::{step.name}" for each in wanted)

    def __exit__(self, *given: Any) -> None:
        self._stack.close()

    @contextmanager
    def _captured(self) -> Iterator[None]:
        """Keep the output of procedures."""
        printed = _Lines(self._lines.append)
        with contextlib.redirect_stdout(printed):
            yield
        printed.end()

    def run(self, step: ProcedureStep) -> ProcedureResult | None:
        """Run a method; returns None for a setup or teardown that passed.

        Args:
            step: one of `steps`.

        Raises:
            KeyboardInterrupt: as given by the user.
        """
        owner = getattr(step.call, "__self__", None)
        ids = marked(getattr(step.call, "__func__", step.call), type(owner)) if owner is not None else ()
        result = ProcedureResult(step.suite, step.name, requirements=ids, is_test=step.is_test)
        self._requirements.current = result.full_name
        self._lines.clear()
        first = 0 if self.flight is None else len(self.flight.events)
        if self.flight is not None:
            self.flight.dictionary.learn(topics_of(self.flight.mission))
            self._targets.learn()
        self._station.begin_test()
        start, watch = self._station.now, Stopwatch()
        ProcedureGroup._current = step.suite, step.group, step.script
        try:
            with self._captured():
                step.call()
        except (SkipScript, StopScript) as error:
            result.verdict, result.message = (SKIP if isinstance(error, SkipScript) else PASS), str(error)
            result.place = self._procedures.place(error)
        except UnsupportedError as error:
            result.verdict, result.message = FAIL, f"refused: {error}"
            result.place = self._procedures.place(error)
        except (Exception, SystemExit) as error:
            named = isinstance(error, UsageError | CfeError | AssertionError | RuntimeError)
            result.verdict = FAIL
            result.message = str(error) if named and str(error) else f"{type(error).__name__}: {error}"
            result.place = self._procedures.place(error)
        finally:
            ProcedureGroup._current = None
        result.seconds, result.wall = self._station.now - start, watch.elapsed_ns() / NS_PER_S
        result.output = list(self._lines)
        if self.flight is not None:
            result.events = [_event_line(each) for each in self.flight.events[first:]]
        self._failed = self._failed or result.verdict == FAIL
        self._requirements.note_test(result.full_name, ids, result.verdict, result.message)
        for each in self._requirements.rows():
            state, message = each.tests.get(result.full_name, ("U", ""))
            if state != "U":
                result.states.append((each.name, state, message))
        return result if step.is_test or result.verdict != PASS else None

    def command(self) -> str:
        """Return the command that repeats the flight."""
        plan = self._settings.plan
        words = ["cfepy", "procedures", str(self._file), *plan.words, "--seed", str(plan.seed)]
        words += ["--schedule", plan.schedule.text()] if plan.schedule != Schedule() else []
        words += ["--faults", plan.faults] if plan.faults else []
        words += ["--ground-seed", str(self._settings.ground_seed)] if self._settings.ground_seed else []
        return command_line(words)


class _Lines(io.TextIOBase):
    """A text file that passes on whole lines."""

    def __init__(self, write: Callable[[str], object]) -> None:
        self._write, self._rest = write, ""

    def write(self, text: str) -> int:
        *lines, self._rest = (self._rest + text).split("\n")
        for each in lines:
            self._write(each)
        return len(text)

    def end(self) -> None:
        """Pass on the last line, which has no line end."""
        if self._rest:
            self._write(self._rest)


def _event_line(event: Any) -> str:
    return f"{event.at_ns / NS_PER_S:.6f} {event.app} {event.event_id} {event.type_name}: {event.text}"


def target_of(file: Path, settings: Settings, mission: str) -> tuple[str, Path | None]:
    """Return the name of the target, and its folder, the one with `procedures` or `cmd_tlm`.

    Args:
        file: file of the procedures.
        settings: may name the target.
        mission: name of the mission, for a file outside of a target's folder.
    """
    folder = next((each for each in file.parents if each.parent.name == TARGETS or (each / "cmd_tlm").is_dir()), None)
    if folder is None:
        return settings.target.upper() or mission.upper(), None
    return settings.target.upper() or folder.name.upper(), folder


def with_schedule(settings: Settings, schedule: Schedule, ground_seed: int) -> Settings:
    """Return settings with another schedule and other delays of the ground station."""
    return replace(settings, plan=replace(settings.plan, schedule=schedule), ground_seed=ground_seed)
