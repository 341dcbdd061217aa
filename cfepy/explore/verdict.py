"""What became of a mission under one schedule: the failures, and the digests that say what it computed.

Plain data that goes between processes and into files. Imports nothing of cfepy.
"""

from __future__ import annotations

import re
from dataclasses import asdict, dataclass
from typing import Any

DIED = "died"
RAISED = "unhandled exception"
ENDED = "ended with an error"
RESET = "processor reset"
DEADLINE = "deadline"
DEADLOCK = "deadlock"
STUCK = "stuck"
EXPECTATION = "missed expectation"
INVARIANT = "invariant"
EVENT = "event"
PROBLEM = "problem"
RESULTS = "results differ"

_PLACE_OR_NUMBER = re.compile(r"(\.\w+:\d+)|(?:0x[0-9A-Fa-f]+|\d+(?:\.\d+)?(?:e[-+]?\d+)?)")


@dataclass(frozen=True, slots=True)
class Failure:
    """Something that must not be.

    Attributes:
        kind: DIED, DEADLOCK, INVARIANT and so on.
        who: the application, invariant, step or result that it is about.
        text: what was wrong, one line.
        at_ns: virtual time at which it was; None when it is the state at the end.
        detail: more lines, such as a traceback; may be empty.
        task: the task in which it showed; empty when that is not known.
    """

    kind: str
    who: str
    text: str
    at_ns: int | None = None
    detail: str = ""
    task: str = ""

    @property
    def group(self) -> str:
        """What failures of one cause have in common: all but numbers, which differ from schedule to schedule.

        Numbers of source lines stay (`checks.py:12`), since they tell causes apart.
        """
        return f"{self.kind}|{self.who}|{_PLACE_OR_NUMBER.sub(lambda found: found[1] or '#', self.text)}"

    @property
    def title(self) -> str:
        """Kind, who and text for a person, in one line."""
        return f"{self.kind}: {self.who}: {self.text}" if self.who else f"{self.kind}: {self.text}"


@dataclass(frozen=True, slots=True)
class Verdict:
    """What became of one schedule.

    Attributes:
        schedule: its text form.
        failures: in the order of their times; none for a run that went well.
        results: digest of the results that must not depend on the schedule; empty when none are selected.
        trace: digest of the whole run.
        decisions: how often the policy was asked.
        deviations: (decision, candidate) where it did not choose as fifo would; kept for runs with failures only.
        preemptions: how many of them took the processor from a task that could have gone on.
        widths: how many answers each decision had, negative where the running task could have gone on; kept only for a
            systematic search.
        end_ns: virtual time at the end of the run, before the nodes were asked to shut down.
        trouble: traceback of an error of cfepy itself, which says nothing about the mission; empty otherwise.
    """

    schedule: str
    failures: tuple[Failure, ...] = ()
    results: str = ""
    trace: str = ""
    decisions: int = 0
    deviations: tuple[tuple[int, int], ...] = ()
    preemptions: int = 0
    widths: tuple[int, ...] = ()
    end_ns: int = 0
    trouble: str = ""

    @property
    def failed(self) -> bool:
        """Whether the mission failed under this schedule."""
        return bool(self.failures)

    @property
    def groups(self) -> tuple[str, ...]:
        """The groups of its failures, each once, in order."""
        return tuple(dict.fromkeys(failure.group for failure in self.failures))

    def failure(self, group: str) -> Failure | None:
        """Its first failure of a group; None when it has none."""
        return next((each for each in self.failures if each.group == group), None)

    def to_dict(self) -> dict[str, Any]:
        """Plain data, for JSON and msgpack."""
        return asdict(self)

    @classmethod
    def from_dict(cls, plain: dict[str, Any]) -> Verdict:
        """The other way round."""
        failures = tuple(Failure(**each) for each in plain["failures"])
        deviations = tuple((int(at), int(candidate)) for at, candidate in plain["deviations"])
        return cls(**{**plain, "failures": failures, "deviations": deviations, "widths": tuple(plain["widths"])})
