"""Flies suites under many schedules and finds the tests whose verdict depends on the schedule.

A ground station is not synchronous with the flight computer, so each schedule but the first has another start of the
procedure and other pauses, too. Applications then poll and send at another moment of each test. The first schedule that
changes the verdict of a test is shrunk and explained by the analysis of `cfepy explore`. Its flight is the experiment.
Late pauses of the ground station are answers of the schedule, so they are left out like its other moves.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from cfepy.attachment import Attachment
from cfepy.extra.exploration import (
    SHRINK_S,
    Failure,
    MadeMove,
    MoveNotingPolicy,
    NotedFlight,
    Shrinker,
    Tried,
    Verdict,
    story_of,
)
from cfepy.extra.procedures.flying_suites import (
    FAIL,
    PASS,
    FlyingSuite,
    Observed,
    ProcedureResult,
    Settings,
    fly_procedures,
    with_schedule,
)
from cfepy.extra.procedures.pauses import LATE_PAUSE, START, AllLate
from cfepy.extra.procedures.procedure_loader import suites_in
from cfepy.extra.procedures.requirements import Requirements
from cfepy.pilot import RunPlan
from cfepy.rtos import HOLD, NotingPolicy, Policy
from cfepy.schedules import Schedule

MOST_PROBES = 200
"""The most flights to shrink one racy test."""
_MOST_MOVES = 4
_MS_PER_S = 1_000
_KINDS = {PASS: "test passed", FAIL: "test failed"}


@dataclass(slots=True)
class Verdicts:
    """The verdicts of one test under all schedules.

    Attributes:
        name: its full name.
        passed, failed: number of schedules.
        first: the first failure.
        schedule, ground_seed: its schedule, and the seed of the pauses.
        differs: the first event of the failing flight that the passing one under fifo does not have at its place.
        verdict: its first verdict, under fifo with exact pauses.
        deviant: the first schedule with the other verdict, and its seed of the pauses; None without one.
        decided: the decisions that change the verdict of a racy test; empty if they are not known.
    """

    name: str
    passed: int = 0
    failed: int = 0
    first: ProcedureResult | None = None
    schedule: str = ""
    ground_seed: int = 0
    differs: str = ""
    events: list[str] = field(default_factory=list)
    verdict: str = ""
    deviant: tuple[Schedule, int] | None = None
    decided: str = ""

    @property
    def is_racy(self) -> bool:
        """Whether the verdict depends on the schedule."""
        return self.passed > 0 and self.failed > 0

    @property
    def cause(self) -> str:
        """Why a racy test fails under some schedules."""
        if self.first is None:
            return ""
        _, between, text = self.first.message.partition("; it was true at ")
        if between:
            missed = f"the procedure looks too rarely: its condition was true at {text}"
            return f"{missed}; {self.decided}" if self.decided else missed
        if self.decided:
            return self.decided
        if self.differs:
            return f"another order of events; the first that differs: {self.differs}"
        return "other values of telemetry with the same events"


def schedules_of(count: int) -> list[Schedule]:
    """Return fifo and random schedules.

    Args:
        count: number of schedules.
    """
    return [Schedule(), *(Schedule.parse(f"random:{seed}") for seed in range(1, count))]


def explore_procedures(
    files: Sequence[Path],
    settings: Settings,
    count: int,
    note: Callable[[str], object] = lambda text: None,
    probes: int = MOST_PROBES,
) -> list[Verdicts]:
    """Fly procedures under many schedules.

    Args:
        files: files of procedures.
        settings: how they fly.
        count: number of schedules.
        note: called with a line about each schedule.
        probes: the most flights to find the decisions of each racy test; 0 does not search for them.

    Returns:
        The verdicts of each test, in order.
    """
    found: dict[str, Verdicts] = {}
    for number, schedule in enumerate(schedules_of(count)):
        result = fly_procedures(files, with_schedule(settings, schedule, number))
        for each in result.tests:
            if not each.is_test:
                continue
            verdicts = found.setdefault(each.full_name, Verdicts(each.full_name))
            texts = [line.partition(" ")[2] for line in each.events]
            verdicts.verdict = verdicts.verdict or each.verdict
            if verdicts.deviant is None and {each.verdict, verdicts.verdict} == {PASS, FAIL}:
                verdicts.deviant = schedule, number
            if each.verdict == PASS:
                verdicts.passed += 1
                verdicts.events = verdicts.events or texts
            elif each.verdict == FAIL:
                verdicts.failed += 1
                if verdicts.first is None:
                    verdicts.first, verdicts.schedule, verdicts.ground_seed = each, schedule.text(), number
                    verdicts.differs = _first_difference(texts, verdicts.events)
        failed = sum(each.verdict == FAIL for each in result.tests)
        note(f"{schedule.text()}, ground seed {number}: {len(result.tests) - failed} passed, {failed} failed")
    for verdicts in found.values():
        if verdicts.deviant is not None and probes:
            note(f"searching for the cause of {verdicts.name}")
            verdicts.decided = _decided(files, settings, verdicts, probes)
    return list(found.values())


def _decided(files: Sequence[Path], settings: Settings, verdicts: Verdicts, probes: int) -> str:
    assert verdicts.deviant is not None
    schedule, seed = verdicts.deviant
    wanted = FAIL if verdicts.verdict == PASS else PASS
    own = with_schedule(settings, schedule, seed)
    places = ((file, suite) for file in files for suite in suites_in(file))
    file, suite = next(each for each in places if verdicts.name.startswith(f"{each[1] or each[0].stem}::"))
    return cause_of_racy(SuiteTrial(file, suite, own, verdicts.name, wanted), schedule, probes)


def _first_difference(events: list[str], usual: list[str]) -> str:
    for own, other in zip(events, usual, strict=False):
        if own != other:
            return f"{own}, where it is {other} under fifo"
    return ""


@dataclass(frozen=True, slots=True)
class SuiteTrial:
    """A suite up to one of its tests as an experiment, with the settings of one ground seed.

    Attributes:
        file, suite: the suite; an empty name for a script.
        settings: how it flies.
        test: full name of the test.
        verdict: the verdict that is explained, PASS or FAIL; it counts as the failure of the experiment.
        events: the events that are failures: none, since the verdict is.
    """

    file: Path
    suite: str
    settings: Settings
    test: str
    verdict: str
    events: str = "none"

    @property
    def plan(self) -> RunPlan:
        """The mission and how it flies."""
        return self.settings.plan

    def fly(self, schedule: Schedule, attachments: Sequence[Attachment] = (), policy: Policy | None = None) -> Tried:
        """Fly the suite up to the test; see `cfepy.extra.exploration.trial.Trial.fly`.

        Args:
            schedule: decides which task runs when, and which pauses are late.
            attachments: observers of the run.
            policy: decides in place of the schedule's own.
        """
        noting = NotingPolicy((schedule.policy() or Policy()) if policy is None else policy)
        settings = with_schedule(self.settings, schedule, self.settings.ground_seed)
        observed = Observed(noting, attachments)
        failures: tuple[Failure, ...] = ()
        with FlyingSuite(self.file, self.suite, settings, Requirements(), observed=observed) as flying:
            for step in flying.steps:
                result = flying.run(step)
                if result is not None and result.full_name == self.test:
                    assert flying.flight is not None
                    now = flying.flight.mission.kernel.now
                    if result.verdict == self.verdict:
                        cause = result.place or self.verdict
                        failures = (Failure(_KINDS[self.verdict], self.test, result.message, now, cause=cause),)
                    break
        deviations = tuple(sorted(noting.deviations.items()))
        preemptions = noting.preemptions
        end_ns = failures[0].at_ns if failures else 0
        return Tried(Verdict(schedule, failures, deviations=deviations, preemptions=preemptions, end_ns=end_ns or 0))

    def until(self, end_ns: int) -> None:
        """Do nothing: the length of a test cannot be changed."""


def cause_of_racy(trial: SuiteTrial, schedule: Schedule, probes: int = MOST_PROBES, most_s: float = SHRINK_S) -> str:
    """Return the decisions that change the verdict of a racy test, and the cause as `cfepy explore` finds it.

    Args:
        trial: the test with the ground seed of its changed verdict.
        schedule: under which its verdict is changed.
        probes: the most flights.
        most_s: the most wall time in s.

    Returns:
        A sentence; empty if the verdict could not be reproduced.
    """

    def fly(experiment: SuiteTrial, tried: Schedule) -> NotedFlight:
        policy = tried.policy() or Policy()
        recorder = MoveNotingPolicy(AllLate(policy) if tried == schedule else policy)
        return NotedFlight.of(experiment.fly(tried, policy=recorder).verdict, recorder)

    first = fly(trial, schedule).verdict
    if not first.failures:
        return ""
    group = first.failures[0].group
    shrunk = Shrinker(trial, [schedule], group, probes, most_s, fly).run()
    if shrunk is None:
        return ""
    failure = shrunk.verdict.failure(group)
    assert failure is not None, "the shrinker returns only flights that show the failure"
    story = story_of(trial, shrunk.verdict, failure, shrunk.moves)
    does = "fails" if trial.verdict == FAIL else "passes"
    decided = f"it {does} if {_moves_text(shrunk.moves)}" if shrunk.moves else f"it {does} with exact pauses"
    if shrunk.is_cut_short:
        decided += f" (not all of them may be necessary: the search ended after {most_s:g} s)"
    return f"{decided}; {story.cause}" if story.cause and story.cause not in decided else decided


def _moves_text(moves: Sequence[MadeMove]) -> str:
    late: dict[str, list[float]] = {}
    for each in moves:
        if each.question == LATE_PAUSE:
            late.setdefault(each.task, []).append(float(each.chosen.removesuffix("ms")))
    texts = [_late_text(name, times) for name, times in late.items()]
    texts += [_move_text(each) for each in moves if each.question != LATE_PAUSE]
    more = len(texts) - _MOST_MOVES
    return " and ".join([*texts[:_MOST_MOVES], *([f"{more} more changes"] if more > 0 else [])])


def _late_text(name: str, times: Sequence[float]) -> str:
    if name == START:
        return f"the procedure starts {times[0] / _MS_PER_S:.2f} s later"
    if len(times) == 1:
        return f"a {name} lasts {times[0]:.0f} ms longer"
    return f"{len(times)} {name.replace('pause', 'pauses', 1)} last {sum(times):.0f} ms longer in all"


def _move_text(move: MadeMove) -> str:
    if move.question:
        return f"{move.task} is {move.chosen}"
    if move.chosen == HOLD:
        return f"{move.task} is delayed"
    return f"{move.chosen} runs before {move.task}"
