"""The verdict on a mission under one schedule, and the findings from the verdicts on many.

A verdict has the failures and the digests of the results: plain data that goes between processes and into files. A
finding is a distinct failure, with its number of occurrences and its first one. The failures of a run usually follow
from each other, so a run counts for the first of them that the reference run does not have.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, fields
from typing import Any

from cfepy.extra.exploration.steps import TaskStep
from cfepy.pilot import Failure, FailureKind
from cfepy.schedules import Schedule
from cfepy.status import UsageError

__all__ = [
    "DEADLINE",
    "DEADLOCK",
    "DIED",
    "ENDED",
    "EVENT",
    "EXPECTATION",
    "INVARIANT",
    "LIVELOCK",
    "LONGEST",
    "OVERWRITE",
    "PROBLEM",
    "RACE",
    "RAISED",
    "RESET",
    "RESULTS",
    "STALLED",
    "STARVED",
    "STUCK",
    "Failure",
    "Finding",
    "Findings",
    "Verdict",
]

DIED = FailureKind.DIED
RAISED = FailureKind.RAISED
ENDED = FailureKind.ENDED
RESET = FailureKind.RESET
DEADLINE = FailureKind.DEADLINE
DEADLOCK = FailureKind.DEADLOCK
RACE = FailureKind.RACE
OVERWRITE = FailureKind.OVERWRITE
STUCK = FailureKind.STUCK
STALLED = FailureKind.STALLED
EXPECTATION = FailureKind.EXPECTATION
INVARIANT = FailureKind.INVARIANT
EVENT = FailureKind.EVENT
PROBLEM = FailureKind.PROBLEM
RESULTS = FailureKind.RESULTS
LONGEST = FailureKind.LONGEST
STARVED = FailureKind.STARVED
LIVELOCK = FailureKind.LIVELOCK
NO_DECIMALS = 9.95  # of the ratio of schedules to failures, from here on
SIMPLEST = 3  # runs that are kept of each finding, to be shrunk


@dataclass(frozen=True, slots=True)
class Verdict:
    """The verdict on one schedule.

    Attributes:
        schedule: the schedule; in plain data its text.
        failures: in the order of their times; empty for a run without failures.
        results: digest of the results that must not depend on the schedule; empty when none are selected.
        trace: digest of the whole run.
        decisions: number of the policy's decisions, without those that `from` leaves to fifo.
        deviations: (decision, candidate) where it did not choose as fifo would; kept for runs with failures, and with
            steps.
        preemptions: number of deviations that took the processor from a task that could have continued.
        widths: number of answers of each decision, negative where the running task could have continued; kept only for
            a systematic search.
        steps: the steps of the tasks with their accesses; kept only for a search of orders.
        end_ns: virtual time at the end of the run, before the shutdown of the nodes.
        longest: for a run with a measure: its longest value, its end in virtual ns, and the number of decisions by
            then; empty if there is none.
        trouble: traceback of an error of cfepy itself, which is not an error of the mission; empty otherwise.
        missed: the moves of the schedule that were not possible, as text.
        switches: numbers of the kinds of its switches, rising; kept only for a search that ends when none is new.
    """

    schedule: Schedule
    failures: tuple[Failure, ...] = ()
    results: str = ""
    trace: str = ""
    decisions: int = 0
    deviations: tuple[tuple[int, int], ...] = ()
    preemptions: int = 0
    widths: tuple[int, ...] = ()
    steps: tuple[TaskStep, ...] = ()
    end_ns: int = 0
    longest: tuple[int, ...] = ()
    trouble: str = ""
    missed: tuple[str, ...] = ()
    switches: tuple[int, ...] = ()

    @property
    def failed(self) -> bool:
        """Whether the mission failed under this schedule."""
        return bool(self.failures)

    @property
    def groups(self) -> tuple[str, ...]:
        """The groups of its failures, each once, in order."""
        return tuple(dict.fromkeys(failure.group for failure in self.failures))

    def failure(self, group: str) -> Failure | None:
        """Return its first failure of a group; None if it has none."""
        return next((each for each in self.failures if each.group == group), None)

    def to_dict(self) -> dict[str, Any]:
        """Return plain data, for JSON and msgpack."""
        same = {each.name: getattr(self, each.name) for each in fields(self)}
        return same | {"schedule": self.schedule.text(), "failures": tuple(map(asdict, self.failures))}

    @classmethod
    def from_dict(cls, plain: dict[str, Any]) -> Verdict:
        """Return a verdict from the data of `to_dict`.

        Raises:
            UsageError: the data is not a verdict.
        """
        try:
            return cls._of(plain)
        except UsageError:
            raise
        except (KeyError, TypeError, ValueError, AttributeError, ArithmeticError) as error:
            raise UsageError(f"is not a verdict: {type(error).__name__}: {error}") from None

    @classmethod
    def _of(cls, plain: dict[str, Any]) -> Verdict:
        schedule = Schedule.parse(plain["schedule"])
        failures = tuple(Failure(**each) for each in plain["failures"])
        deviations = tuple((int(at), int(candidate)) for at, candidate in plain["deviations"])
        missed = tuple(plain.get("missed", ()))
        steps = tuple(TaskStep.of(each) for each in plain.get("steps", ()))
        own = {"schedule": schedule, "failures": failures, "deviations": deviations, "missed": missed, "steps": steps}
        own["switches"] = tuple(map(int, plain.get("switches", ())))
        longest = tuple(map(int, plain.get("longest", ())))
        found = cls(**{**plain, **own, "widths": tuple(map(int, plain["widths"])), "longest": longest})
        texts = [found.results, found.trace, found.trouble, *found.missed]
        for each in failures:
            texts += [each.kind, each.who, each.text, each.detail, each.task, each.cause]
        numbers = [found.decisions, found.preemptions, found.end_ns, *(each.at_ns or 0 for each in failures)]
        if not all(isinstance(each, str) for each in texts) or not all(isinstance(each, int) for each in numbers):
            raise TypeError("a text or a number has the wrong type")
        return found


@dataclass(slots=True)
class Finding:
    """A distinct failure.

    Attributes:
        failure: its first occurrence.
        number: of the first schedule that showed it, from 0; None for the reference run.
        verdict: on that schedule.
        numbers: of all schedules that showed it.
        others: titles of the other failures in the first run.
        simplest: the verdicts of the runs that showed it with the fewest preemptions: the best ones to shrink.
    """

    failure: Failure
    number: int | None
    verdict: Verdict
    numbers: list[int] = field(default_factory=list)
    others: tuple[str, ...] = ()
    simplest: list[Verdict] = field(init=False)

    def __post_init__(self) -> None:
        self.simplest = [self.verdict]

    def again(self, number: int, verdict: Verdict) -> None:
        """Add another run that showed it."""
        self.numbers.append(number)
        if verdict is not self.verdict:
            self.simplest = sorted([*self.simplest, verdict], key=_moves)[:SIMPLEST]

    @property
    def in_reference(self) -> bool:
        """Whether the default schedule shows it as well."""
        return self.number is None

    def frequency(self, done: int) -> str:
        """Return how often it showed, for the user: "2 of 60 schedules, first number 4; one in 30".

        Args:
            done: number of schedules that were tried, at least one of which showed it.
        """
        ratio = done / len(self.numbers)
        rounded = f"{ratio:,.0f}" if ratio >= NO_DECIMALS else f"{ratio:.1f}".removesuffix(".0")
        return f"{len(self.numbers)} of {done} schedules, first number {self.numbers[0]}; one in {rounded}"

    def to_dict(self) -> dict[str, Any]:
        """Return plain data; times in ns."""
        return {
            "kind": self.failure.kind,
            "who": self.failure.who,
            "text": self.failure.text,
            "at_ns": self.failure.at_ns,
            "detail": self.failure.detail,
            "others": list(self.others),
            "under_fifo": self.in_reference,
            "schedules": len(self.numbers),
            "first_number": self.number,
            "first_schedule": self.verdict.schedule.text(),
        }


def _moves(verdict: Verdict) -> tuple[int, int]:
    """Return a measure of the difference between a schedule and the default one."""
    return verdict.preemptions, len(verdict.deviations)


class Findings:
    """Collects findings.

    Args:
        reference: the verdict on the default schedule.

    Attributes:
        troubles: verdicts that ended in an error of cfepy.
    """

    def __init__(self, reference: Verdict) -> None:
        self.troubles: list[Verdict] = [reference] if reference.trouble else []
        self._found: dict[str, Finding] = {}
        self._expected = frozenset(reference.groups)
        for failure in reference.failures:
            self._found.setdefault(failure.group, Finding(failure, None, reference))

    def take(self, number: int, verdict: Verdict) -> bool:
        """Take a verdict. Returns True if the mission failed in a way in which it does not fail by default."""
        if verdict.trouble:
            self.troubles.append(verdict)
        if not verdict.failures:
            return False
        new = [failure for failure in verdict.failures if failure.group not in self._expected]
        failure = (new or verdict.failures)[0]
        others = tuple(dict.fromkeys(each.title for each in new if each.group != failure.group))
        finding = self._found.setdefault(failure.group, Finding(failure, number, verdict, others=others))
        finding.again(number, verdict)
        return bool(new)

    def all(self) -> list[Finding]:
        """Return all findings: the ones of the reference run, then the others as they were found."""
        return list(self._found.values())
