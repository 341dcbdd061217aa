"""What monitors write into the record of a run: how deadlines were kept, and which invariants did not hold.

`RunRecord.part` keeps a `DeadlineRecord` and an `InvariantRecords` for each run, over all resets of the processor.
"""

from __future__ import annotations

from dataclasses import dataclass, field

from cfepy.monitors.deadlines import Check, Overrun


@dataclass(slots=True)
class DeadlineRecord:
    """The deadlines of a run: the checks as in the mission file, and the first overruns of each."""

    checks: list[Check] = field(default_factory=list)
    overruns: list[Overrun] = field(default_factory=list)


@dataclass(frozen=True, slots=True)
class Violation:
    """An invariant did not hold: what was wrong, when in virtual ns, the sender, and the message."""

    text: str
    at_ns: int
    sender: str
    detail: str = ""


@dataclass(slots=True)
class InvariantRecord:
    """What became of an invariant: `place` is `file:line`, `judged` and `violated` count messages."""

    name: str
    place: str
    judged: int = 0
    violated: int = 0
    first: Violation | None = None


class InvariantRecords(dict[str, InvariantRecord]):
    """The invariants of a run, by name, as in the mission file."""
