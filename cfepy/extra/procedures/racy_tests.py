"""Flies suites under many schedules and finds the tests whose verdict depends on the schedule.

A ground station is not synchronous with the flight computer, so each schedule but the first has another start of the
procedure and other pauses, too. Applications then poll and send at another moment of each test. The first schedule that
changes the verdict of a test is shrunk to the decisions that change it.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from pathlib import Path

from cfepy.extra.procedures.flying_suites import FAIL, PASS, ProcedureResult, Settings, fly_procedures, with_schedule
from cfepy.extra.procedures.procedure_loader import suites_in
from cfepy.extra.procedures.racy_causes import MOST_PROBES, SuiteTrial, cause_of_racy
from cfepy.schedules import Schedule


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
