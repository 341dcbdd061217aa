"""A failure of a run: something that must not be, with what tells one cause from another.

It is plain data, which goes between processes and into files. `cfepy.pilot.problems` finds the failures of a run.
"""

from __future__ import annotations

import re
from dataclasses import dataclass


class FailureKind:
    """What a failure is: the first words that are told of it."""

    DIED = "died"
    RAISED = "unhandled exception"
    ENDED = "ended with an error"
    RESET = "processor reset"
    DEADLINE = "deadline"
    DEADLOCK = "deadlock"
    RACE = "data race"
    OVERWRITE = "overwritten memory"
    STUCK = "stuck"
    STALLED = "stalled"
    EXPECTATION = "missed expectation"
    INVARIANT = "invariant"
    EVENT = "event"
    PROBLEM = "problem"
    RESULTS = "results differ"
    LONGEST = "longest"
    STARVED = "starved"
    LIVELOCK = "livelock"


LEAVES_OTHERS_WAITING = frozenset(
    [
        FailureKind.DIED,
        FailureKind.RAISED,
        FailureKind.ENDED,
        FailureKind.RESET,
        FailureKind.DEADLOCK,
        FailureKind.STALLED,
    ]
)
"""What takes a task away, for which others may wait then."""
_PLACE_OR_VALUE = re.compile(
    r"(?P<kept>\.\w+:\d+)|0x[0-9A-Fa-f]+|\d+(?:\.\d+)?(?:e[-+]?\d+)?|(?<!\w)'[^']*'|\"[^\"]*\"", re.ASCII
)


@dataclass(frozen=True, slots=True)
class Failure:
    """Something that must not be.

    Attributes:
        kind: one of `FailureKind`.
        who: the application, invariant, step or result that it is about.
        text: what was wrong, one line.
        at_ns: virtual time at which it was; None when it is the state at the end.
        detail: more lines, such as a traceback; may be empty.
        task: the task in which it showed; empty when that is not known.
        cause: what tells causes of this kind apart, such as the id of an event; empty where it is the text.
        span_ns: of a deadline, how long before `at_ns` the time began in which it should have been; None of others.
    """

    kind: str
    who: str
    text: str
    at_ns: int | None = None
    detail: str = ""
    task: str = ""
    cause: str = ""
    span_ns: int | None = None

    @property
    def group(self) -> str:
        """What failures of one cause have in common.

        Of a text that is all but numbers and quoted texts, which differ from schedule to schedule. Numbers of source
        lines stay (`checks.py:12`), since they tell causes apart.
        """
        cause = self.cause or _PLACE_OR_VALUE.sub(lambda found: found["kept"] or "#", self.text)
        return f"{self.kind}|{self.who}|{cause}"

    @property
    def title(self) -> str:
        """Kind, who and text for a person, in one line."""
        return f"{self.kind}: {self.who}: {self.text}" if self.who else f"{self.kind}: {self.text}"
