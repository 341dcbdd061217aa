"""The pilot: it flies a `RunPlan`, the same way for every command, journal, trial and test.

    flown = fly(RunPlan(("capture",), seconds=20))
    with takeoff(plan, attachments=[watch]) as run:
        run.run_until(NS_PER_S)

`fly` goes to the end of the run. `takeoff` gives a run that stands at virtual time 0 to a caller that lets it go on by
itself. Both check the plan, add what the mission file, the script and the faults ask for to a bare `Mission`, and
collect warnings for the user. What the host does between two pieces of a run is a `Host`.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, TypedDict, Unpack

from cfepy.attachment import Attachment
from cfepy.interpreter.cached import CachedProperty
from cfepy.mission import Mission, MissionSpec, endless_waits
from cfepy.pilot.plan import RunPlan
from cfepy.pilot.problems import RunProblem, problems_of
from cfepy.pilot.results import Mark, Results, never_happened
from cfepy.pilot.run_loop import BROKEN_OFF, INTERRUPTED, OVER, STALLED, Course
from cfepy.rtos import LastResort, Policy
from cfepy.status import CfeError, StallError, UsageError
from cfepy.trace import Trace
from cfepy.writing.console import Console

if TYPE_CHECKING:
    from cfepy.script import Outcome, ScriptRun

MakeCourse = Callable[[Mission, float | None, "ScriptRun | None"], Course]


class BootError(UsageError):
    """The mission cannot boot, or a call of the host's into it failed."""


class Host:
    """The host's side of a run: this one lets it go on in one go, and looks at nothing.

    Attributes:
        longest_s: virtual seconds of a run whose plan gives no length; None for the usual ones.
        owns_process: this process does nothing else, so that it may end when a task cannot be ended.
    """

    longest_s: float | None = None
    owns_process = False

    @property
    def asked(self) -> bool:
        """Whether the run is to end at the next occasion."""
        return False

    def begin(self, run: LiveRun) -> None:
        """The run stands at virtual time 0."""
        self._mission = run.mission

    def step(self, until_ns: int) -> None:
        """Let it go on, to a virtual time in ns at the most."""
        self._mission.run_until(until_ns)

    def wall_ns(self) -> int:
        """Wall-clock time of the run so far; 0 here, since a plain run has the same results every time."""
        return 0

    def take_break(self) -> bool:
        """KeyboardInterrupt came out of the run; whether it ends like this, or the exception goes on."""
        return False

    def give_up(self, why: BaseException) -> None:
        """A task cannot be ended, and neither can the run, which is on its thread: end the process, if it is owned.

        Called in another thread.
        """

    def end(self) -> None:
        """The run is over; its mission has not been closed yet."""


@dataclass(frozen=True)
class Flown:
    """A run that is over.

    Attributes:
        mission: closed; what it left behind can be looked at.
        at: its state when its time was over.
        trace: the digest of the run; empty when it was broken off.
        outcome: of its script, None without one.
        reason: how it ended (`cfepy.pilot.run_loop`).
        known: what its user should know, and was known before the run.
    """

    mission: Mission
    at: Mark
    trace: str
    outcome: Outcome | None
    reason: str = OVER
    known: tuple[str, ...] = ()

    @CachedProperty
    def results(self) -> Results:
        """Its numbers: a search that flies thousands of times does not want them of each run."""
        return Results.of(self.mission, self.at, self.trace, self.problems)

    @CachedProperty
    def problems(self) -> list[RunProblem]:
        """What went wrong in it; without one it went well."""
        return problems_of(self.mission, self.at.endless, self.outcome)

    @property
    def notes(self) -> tuple[str, ...]:
        """What its user should know: what was known before the run, and what of its plan never happened in it."""
        return (*self.known, *never_happened(self.mission))

    @property
    def stall(self) -> StallError | None:
        """The task that did not give up the CPU; None when each has."""
        return self.mission.stall

    @property
    def interrupted(self) -> bool:
        """Whether the host wanted it to end before its time."""
        return self.reason in (INTERRUPTED, BROKEN_OFF)


class LiveRun:
    """A run that goes on; `takeoff` makes it.

    Args:
        plan: what is flown.
        mission: the mission, with everything attached.
        course: how long it goes on.
        script: what happens on the way; None for nothing.
        host: the host's side.
        notes: what its user should know.
        beside: the runs of the missions that fly beside it.
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

        A task that does not give up the CPU ends the run; `Flown.stall` tells of it.

        Raises:
            KeyboardInterrupt: of a task, or of the user whom the host does not listen to.
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
        """Run to a virtual time in ns, with all that the script does on the way; no further than the course goes.

        Raises:
            StallError: a task does not give up the CPU.
        """
        while self.step(until_ns):
            pass

    def step(self, until_ns: int) -> bool:
        """One piece of `run_until`, as long as the host takes for one; whether there was one to go."""
        stop_ns = self.course.next_stop()
        if not self.course.goes_on or self.mission.kernel.now >= until_ns or self._host.asked:
            return False
        self._host.step(min(stop_ns, until_ns))
        return True

    def end(self, wall_ns: int = 0) -> None:
        """The time of the run is over: take down its state, and let the nodes shut down. A second call does nothing.

        Args:
            wall_ns: wall-clock time that the run took.
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
        """What went wrong in it until now, or until its time was over, a line each."""
        endless = self.course.at.endless if self._is_concluded else endless_waits(self.mission)
        return [problem.text for problem in problems_of(self.mission, endless, self.course.outcome)]

    def _break_off(self, reason: str) -> None:
        """The run ended in the middle of something: what its trace has come to is no digest of a run."""
        self.reason = reason
        self._conclude(self._host.wall_ns())
        self.mission.finish()
        self._digest = ""

    @property
    def is_over(self) -> bool:
        """Whether the results of the run were collected."""
        return self._digest is not None

    def flown(self) -> Flown:
        """What it came to, when the mission has been closed."""
        assert self._digest is not None
        return Flown(self.mission, self.course.at, self._digest, self.course.outcome, self.reason, self.notes)


class TakeoffOptions(TypedDict, total=False):
    """What `takeoff` and `fly` take besides a plan; `takeoff` tells of each."""

    spec: MissionSpec | None
    attachments: Sequence[Attachment]
    console: Console | None
    policy: Policy | None
    trace: Trace | None
    make_course: MakeCourse
    host: Host | None


def fly(plan: RunPlan, **options: Unpack[TakeoffOptions]) -> Flown:
    """Fly a plan to its end; options and errors as of `takeoff`."""
    run: LiveRun | None = None
    try:
        with takeoff(plan, **options) as run:
            run.go()
    except KeyboardInterrupt:
        host = options.get("host")
        if run is None or not run.is_over or host is None or not host.take_break():
            raise
        # A task would not end; the process ends it, and the numbers are there.
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
    """Around a run: the mission stands at virtual time 0, and is closed at the end.

    Args:
        plan: what to fly.
        spec: the mission, when it has been read already; None reads that of the plan.
        attachments: what watches the run or changes it, besides the monitors, the script and the faults.
        console: takes the lines; None drops them.
        policy: decides which task goes first, in place of the plan's schedule, such as one that records.
        trace: takes the records; None keeps the digest alone.
        make_course: makes the course that it flies.
        host: the host's side; None lets it go on by itself.

    Raises:
        UsageError: something in the plan is wrong, does not fit the mission, or is not installed; the mission cannot
            boot.
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
    """Around what boots a mission.

    Args:
        script: its startup script.

    Raises:
        BootError: in place of the CfeError that says why it does not boot.
    """
    try:
        yield
    except CfeError as error:
        raise BootError(f"the mission cannot boot: {error}", file=script) from error


@contextmanager
def _company(plan: RunPlan, spec: MissionSpec, mission: Mission, course: Course) -> Iterator[list[LiveRun]]:
    """Around a run: the runs of the missions that fly beside it."""
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
    """The console of a mission that flies beside another one, whose console shows its lines."""
    return Console(sink=lambda line: console.show(f"{name}: {line}"))


def _watch_for_stalls(mission: Mission, plan: RunPlan, host: Host) -> None:
    watch = mission.stall_watch
    watch.limit_s = plan.stall
    watch.wanted = lambda: host.asked
    if host.owns_process:
        watch.on_lost = host.give_up
        watch.last_resort = LastResort()


def _judges(spec: MissionSpec) -> list[Attachment]:
    """What must hold of the run, as the mission file says; only a mission that says so imports it."""
    if not spec.demands:
        return []
    from cfepy.monitors import judges_of

    return judges_of(spec)


def _own(plan: RunPlan, script: ScriptRun | None) -> list[Attachment]:
    """What the plan itself brings along."""
    return [*([] if script is None else [script]), *plan.attachments()]


def _policy(plan: RunPlan) -> Policy | None:
    """That of the schedule; races are found by a kernel that asks one, if only for the default."""
    return plan.schedule.policy() or (Policy() if plan.races else None)


def _race_watch(plan: RunPlan) -> list[Attachment]:
    """What finds races; only a run that asks for them imports it."""
    if not plan.races:
        return []
    from cfepy.monitors import RaceWatch

    return [RaceWatch()]


def _script_run(plan: RunPlan, spec: MissionSpec) -> ScriptRun | None:
    """The script, ready to be attached; only a run with one imports what it needs."""
    if plan.script is None:
        return None
    from cfepy.script import ScriptRun

    return ScriptRun.read(plan.script, spec, plan.stop_on_failure)


def _faults(plan: RunPlan, spec: MissionSpec) -> tuple[list[Attachment], list[str]]:
    """What lets the faults happen, and what of their plan is not in the mission; only a run with some imports it."""
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
