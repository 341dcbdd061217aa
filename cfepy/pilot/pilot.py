"""The pilot: it flies a `RunPlan` in the same way for every command, journal, trial and test.

    flown = fly(RunPlan(("capture",), seconds=20))
    with takeoff(plan, attachments=[watch]) as run:
        run.run_until(NS_PER_S)

`fly` flies a run to its end. `takeoff` returns a run paused at virtual time 0, which the caller continues. Both check
the plan, add the attachments for the mission file, the script and the faults to a bare `Mission`, and collect warnings
for the user. A `Host` defines the host's actions between two parts of a run.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypedDict, Unpack

from cfepy.attachment import Attachment
from cfepy.interpreter.cached import CachedProperty
from cfepy.mission import Mission, MissionSpec, endless_waits, note_waits
from cfepy.pilot.plan import RunPlan
from cfepy.pilot.problems import RunProblem, problems_of
from cfepy.pilot.results import Mark, Results, never_happened, rules_without_input
from cfepy.pilot.run_loop import BROKEN_OFF, INTERRUPTED, OVER, STALLED, Course
from cfepy.rtos import LastResort, Policy
from cfepy.status import CfeError, StallError, UsageError
from cfepy.trace import Trace
from cfepy.writing.console import Console

if TYPE_CHECKING:
    from cfepy.script import Outcome, ScriptRun

MakeCourse = Callable[[Mission, float | None, "ScriptRun | None"], Course]


class BootError(UsageError):
    """Exception for a mission that cannot boot, or a failed call of the host into it."""


class Host:
    """The host's side of a run; this base class runs it without a break.

    Attributes:
        longest_s: virtual seconds of a run whose plan has no length; None for the default.
        owns_process: whether this process has no other work, so that it may be ended if a task cannot be ended.
    """

    longest_s: float | None = None
    owns_process = False

    @property
    def asked(self) -> bool:
        """Whether the run should end at the next opportunity."""
        return False

    def begin(self, run: LiveRun) -> None:
        """Handle a run that is paused at virtual time 0."""
        self._mission = run.mission

    def step(self, until_ns: int) -> None:
        """Run it, at most to a virtual time in ns."""
        self._mission.run_until(until_ns)

    def wall_ns(self) -> int:
        """Return the wall-clock time of the run so far; 0 here, because a plain run always has the same results."""
        return 0

    def take_break(self) -> bool:
        """Handle a KeyboardInterrupt from the run; return whether the run ends normally, instead of raising the
        exception.
        """
        return False

    def give_up(self, why: BaseException) -> None:
        """End the process, if it is owned, because a task on the run's own thread cannot be ended.

        It is called in another thread.
        """

    def end(self) -> None:
        """Handle the end of the run, before its mission is closed."""


@dataclass(frozen=True)
class Flown:
    """A run that has ended.

    Attributes:
        mission: the closed mission, whose data can be read.
        at: its state at the end of its time.
        trace: the digest of the run; empty if it was broken off.
        outcome: the result of its script; None without one.
        reason: how it ended (`cfepy.pilot.run_loop`).
        known: notes for the user from before the run.
        never_judged: rules of the mission file without input. They are determined at the end of the run, because a
            replay's files disappear after it.
    """

    mission: Mission
    at: Mark
    trace: str
    outcome: Outcome | None
    reason: str = OVER
    known: tuple[str, ...] = ()
    never_judged: Sequence[str] = ()

    @CachedProperty
    def results(self) -> Results:
        """Return its numbers, computed on demand, because a search over thousands of runs does not need them
        for each.
        """
        return Results.of(self.mission, self.at, self.trace, self.problems, self.never_judged)

    @CachedProperty
    def problems(self) -> list[RunProblem]:
        """Return its problems; a run without problems went well."""
        return problems_of(self.mission, self.at.endless, self.outcome)

    @property
    def notes(self) -> tuple[str, ...]:
        """Notes for the user: those from before the run, and the parts of its plan that never happened."""
        return (*self.known, *never_happened(self.mission, self.never_judged))

    @property
    def stall(self) -> StallError | None:
        """The error about a task that did not give up the CPU; None if there was none."""
        return self.mission.stall

    @property
    def interrupted(self) -> bool:
        """Whether the host ended it early."""
        return self.reason in (INTERRUPTED, BROKEN_OFF)


class LiveRun:
    """A run in progress; `takeoff` creates it.

    Args:
        plan: the plan of the run.
        mission: the mission with all attachments.
        course: the length of the run.
        script: the script; None for none.
        host: the host's side.
        notes: notes for the user.
        beside: the runs of the missions that fly together with it.
    """

    def __init__(
        self,
        plan: RunPlan,
        mission: Mission,
        course: Course,
        script: ScriptRun | None,
        host: Host,
        notes: tuple[str, ...] = (),
        beside: Sequence[LiveRun] = (),
    ) -> None:
        self.plan = plan
        self.mission = mission
        self.course = course
        self.script = script
        self.notes = notes
        self.reason = OVER
        self._host = host
        self._beside = beside
        self._is_concluded = False
        self._digest: str | None = None

    def go(self) -> None:
        """Run to the end of the course, let the nodes shut down, and collect the results.

        A task that does not give up the CPU ends the run; `Flown.stall` has the error.

        Raises:
            KeyboardInterrupt: from a task, or from the user if the host does not handle it.
        """
        course, host = self.course, self._host
        try:
            stop_ns = course.next_stop()
            while course.goes_on and not host.asked:
                host.step(stop_ns)
                stop_ns = course.next_stop()
            self.reason = INTERRUPTED if host.asked else OVER
            self.end(host.wall_ns())
        except KeyboardInterrupt:
            if not host.take_break():
                raise
            self._break_off(BROKEN_OFF)
        except StallError:
            self._break_off(BROKEN_OFF if host.asked else STALLED)

    def run_until(self, until_ns: int) -> None:
        """Run to a virtual time in ns, with all steps of the script, but not beyond the course.

        Raises:
            StallError: if a task does not give up the CPU.
        """
        while self.step(until_ns):
            pass

    def step(self, until_ns: int) -> bool:
        """Run one part of `run_until`, as long as the host's steps; return whether there was one."""
        stop_ns = self.course.next_stop()
        if not self.course.goes_on or self.mission.kernel.now >= until_ns or self._host.asked:
            return False
        self._host.step(min(stop_ns, until_ns))
        return True

    def end(self, wall_ns: int = 0) -> None:
        """End the time of the run: record its state, and let the nodes shut down. A second call does nothing.

        Args:
            wall_ns: wall-clock time of the run in ns.
        """
        if self._digest is None and self.mission.stall is not None:
            self._break_off(STALLED)
        elif self._digest is None:
            self._conclude(wall_ns)
            self.mission.shut_down_nodes()
            self._digest = self.mission.finish()

    def _conclude(self, wall_ns: int) -> None:
        if not self._is_concluded:
            self._is_concluded = True
            self.course.end(wall_ns)
            for each in self._beside:
                each._conclude(0)

    def problems(self) -> list[str]:
        """Return its problems so far, or until its time was over, one per line."""
        endless = self.course.at.endless if self._is_concluded else endless_waits(self.mission)
        return [problem.text for problem in problems_of(self.mission, endless, self.course.outcome)]

    def _break_off(self, reason: str) -> None:
        """End a run that was broken off; its trace has no valid digest."""
        self.reason = reason
        self._conclude(self._host.wall_ns())
        self.mission.finish()
        self._digest = ""

    @property
    def is_over(self) -> bool:
        """Whether the results of the run are complete."""
        return self._digest is not None

    def flown(self) -> Flown:
        """Return the end state, after the mission was closed."""
        assert self._digest is not None
        at, outcome, unjudged = self.course.at, self.course.outcome, rules_without_input(self.mission)
        return Flown(self.mission, at, self._digest, outcome, self.reason, self.notes, unjudged)


class TakeoffOptions(TypedDict, total=False):
    """The options of `takeoff` and `fly` besides the plan; see `takeoff`."""

    spec: MissionSpec | None
    attachments: Sequence[Attachment]
    console: Console | None
    policy: Policy | None
    trace: Trace | None
    make_course: MakeCourse
    host: Host | None


def fly(plan: RunPlan, **options: Unpack[TakeoffOptions]) -> Flown:
    """Fly a plan to its end; see `takeoff` for options and errors."""
    run: LiveRun | None = None
    try:
        with takeoff(plan, **options) as run:
            run.go()
    except KeyboardInterrupt:
        host = options.get("host")
        if run is None or not run.is_over or host is None or not host.take_break():
            raise
        # A task would not end; the process will end it, and the results are complete.
    return run.flown()


@contextmanager
def takeoff(
    plan: RunPlan,
    *,
    spec: MissionSpec | None = None,
    attachments: Sequence[Attachment] = (),
    console: Console | None = None,
    policy: Policy | None = None,
    trace: Trace | None = None,
    make_course: MakeCourse = Course,
    host: Host | None = None,
) -> Iterator[LiveRun]:
    """Start a run; a context manager. The mission is paused at virtual time 0, and is closed at the end.

    Args:
        plan: the plan.
        spec: the mission if it was already read; None reads the plan's.
        attachments: objects that observe or modify the run, in addition to the monitors, the script and the faults.
        console: gets the lines; None drops them.
        policy: decides which task runs next, instead of the plan's schedule, such as a recording one.
        trace: gets the records; None keeps only the digest.
        make_course: creates the course of the run.
        host: the host's side; None runs without a break.

    Raises:
        UsageError: if the plan is wrong, does not match the mission or needs something that is not installed, or the
            mission cannot boot.
    """
    spec = plan.spec() if spec is None else spec
    host = Host() if host is None else host
    script = _script_run(plan, spec)
    with booting(spec.script):
        faults, problems = _faults(plan, spec)
        mission = _mission(
            plan,
            spec,
            console,
            _policy(plan) if policy is None else policy,
            trace,
            [*_judges(spec), *_race_watch(plan), *_own(plan, script), *attachments, *faults],
        )
        mission.on_bad_end = note_waits
    _watch_for_stalls(mission, plan, host)
    seconds = plan.virtual_s
    if plan.seconds is None and script is None and host.longest_s is not None:
        seconds = host.longest_s
    course = make_course(mission, seconds, script)
    with mission, _company(plan, spec, mission, course) as beside:
        run = LiveRun(plan, mission, course, script, host, (*spec.notes, *problems), beside)
        host.begin(run)
        try:
            with booting(spec.script):
                yield run
        finally:
            host.end()


@contextmanager
def booting(script: Path) -> Iterator[None]:
    """Convert errors of booting a mission; a context manager.

    Args:
        script: its startup script.

    Raises:
        BootError: instead of a CfeError.
    """
    try:
        yield
    except CfeError as error:
        raise BootError(f"the mission cannot boot: {error}", file=script) from error


@contextmanager
def _company(plan: RunPlan, spec: MissionSpec, mission: Mission, course: Course) -> Iterator[list[LiveRun]]:
    """Start the missions that fly together with a run; a context manager with their runs."""
    runs: list[LiveRun] = []
    if not plan.beside or not course.takes_company:
        yield runs
        return
    from cfepy.pilot.peers import Companion, Company

    members = [Companion("", mission, 0, mission.run_until, list)]
    with ExitStack() as flights:
        for (text, other, begins_ns), other_spec in zip(plan.companions(), spec.beside, strict=True):
            console = _beside(mission.console, other.words[0])
            run = flights.enter_context(takeoff(other, spec=other_spec, console=console))
            runs.append(run)
            members.append(Companion(text, run.mission, begins_ns, run.run_until, run.problems))
        mission.meet = Company(members).advance
        yield runs


def _beside(console: Console, name: str) -> Console:
    """Return the console of a mission that flies together with another one, whose console shows its lines."""
    return Console(sink=lambda line: console.show(f"{name}: {line}"))


def _watch_for_stalls(mission: Mission, plan: RunPlan, host: Host) -> None:
    watch = mission.stall_watch
    watch.limit_s = plan.stall
    watch.wanted = lambda: host.asked
    if host.owns_process:
        watch.on_lost = host.give_up
        watch.last_resort = LastResort()


def _judges(spec: MissionSpec) -> list[Attachment]:
    """Return the attachments for the rules in the mission file; only a mission with rules loads them."""
    if not spec.demands:
        return []
    from cfepy.monitors import judges_of

    return judges_of(spec)


def _own(plan: RunPlan, script: ScriptRun | None) -> list[Attachment]:
    """Return the attachments of the plan itself."""
    return [*([] if script is None else [script]), *plan.attachments()]


def _policy(plan: RunPlan) -> Policy | None:
    """Return the policy of the schedule; race detection needs a kernel that asks one, even the default."""
    return plan.schedule.policy() or (Policy() if plan.races else None)


def _race_watch(plan: RunPlan) -> list[Attachment]:
    """Return the race detector; only a run with `races` loads it."""
    if not plan.races:
        return []
    from cfepy.monitors import RaceWatch

    return [RaceWatch()]


def _script_run(plan: RunPlan, spec: MissionSpec) -> ScriptRun | None:
    """Return the script, ready to be attached; only a run with one loads the code for it."""
    if plan.script is None:
        return None
    from cfepy.script import ScriptRun

    return ScriptRun.read(plan.script, spec, plan.stop_on_failure)


def _faults(plan: RunPlan, spec: MissionSpec) -> tuple[list[Attachment], list[str]]:
    """Return the fault injector, and the problems of the fault plan; only a run with faults loads it."""
    if plan.faults is None:
        return [], []
    from cfepy.faults import prepare

    prepared = prepare(plan.faults, spec)
    return [prepared.injector], [str(problem) for problem in prepared.problems]


def _mission(
    plan: RunPlan,
    spec: MissionSpec,
    console: Console | None,
    policy: Policy | None,
    trace: Trace | None,
    attachments: Sequence[Attachment],
) -> Mission:
    try:
        return Mission(
            spec,
            seed=plan.seed,
            board=plan.board,
            tasks=plan.tasks,
            console=Console(quiet=True) if console is None else console,
            policy=policy,
            trace=trace,
            attachments=attachments,
        )
    except UsageError:
        raise
    except ValueError as error:  # a task context that is not installed
        raise UsageError(str(error), field="--tasks") from None
