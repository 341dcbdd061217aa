"""A failure of a run, with an identification of its cause.

It is plain data, passed between processes and into files. `cfepy.pilot.problems` finds the failures of a run.
"""

from __future__ import annotations

import re
from dataclasses import dataclass


class FailureKind:
    """The kind of a failure: the first words of its text."""

    DIED = "died"
    RAISED = "unhandled exception"
    ENDED = "ended with an error"
    RESET = "processor reset"
    DEADLINE = "deadline"
    DEADLOCK = "deadlock"
    RACE = "data race"
    OVERWRITE = "overwritten memory"
    LEAK = "not given back"
    WAITING_LOAD = "waiting load"
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
"""The kinds of failures that remove a task, for which others may then wait."""
_PLACE_OR_VALUE = re.compile(
    r"(?P<kept>\.\w+:\d+)|0x[0-9A-Fa-f]+|\d+(?:\.\d+)?(?:e[-+]?\d+)?|(?<!\w)'[^']*'|\"[^\"]*\"", re.ASCII
)


@dataclass(frozen=True, slots=True)
class Failure:
    """A failure of a run.

    Attributes:
        kind: one of `FailureKind`.
        who: the application, invariant, step or result concerned.
        text: a one-line description.
        at_ns: virtual time in ns; None if it is about the state at the end.
        detail: more lines, such as a traceback; may be empty.
        task: the task that showed it; empty if unknown.
        cause: identifies the cause within the kind, such as the id of an event; empty if the text does.
        span_ns: for a deadline, the length of its time window before `at_ns` in ns; otherwise None.
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
        """The key shared by failures with the same cause.

        It is the text without numbers and quoted texts, which differ from schedule to schedule. Numbers of source lines
        stay (`checks.py:12`), because they distinguish causes.
        """
        cause = self.cause or without_values(self.text)
        return f"{self.kind}|{self.who}|{cause}"

    @property
    def name(self) -> str:
        """A name for display that is the same in all runs: the group, with # for numbers and quoted texts."""
        return name_of_group(self.group)

    @property
    def title(self) -> str:
        """Kind, subject and text, in one line for display."""
        return f"{self.kind}: {self.who}: {self.text}" if self.who else f"{self.kind}: {self.text}"


def without_values(text: str) -> str:
    """Return a text with # for numbers and quoted texts; numbers of source lines stay."""
    return _PLACE_OR_VALUE.sub(lambda found: found["kept"] or "#", text)


def name_of_group(group: str) -> str:
    """Return the name of a failure (`Failure.name`) from its group."""
    return ": ".join(part for part in group.split("|", 2) if part)
