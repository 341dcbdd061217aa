"""The record of a run: what its report tells, collected over all resets of the processor."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any

from cfepy.es.records import AppHistory
from cfepy.sb import SoftwareBus

if TYPE_CHECKING:
    from cfepy.mission.deadline_checks import Check, Overrun


@dataclass(frozen=True, slots=True)
class Reset:
    """A reset of the processor.

    Args:
        at_ns: virtual time.
        reset_type: RST_TYPE_PROCESSOR or RST_TYPE_POWERON.
        reason: who wanted it, and why.
        fault: it followed from a failure; otherwise somebody asked for it.
    """

    at_ns: int
    reset_type: int
    reason: str
    fault: bool


@dataclass(frozen=True, slots=True)
class Violation:
    """An invariant did not hold: what was wrong, when in virtual ns, who sent the message, and the message."""

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


@dataclass(slots=True)
class Traffic:
    """What became of the messages of one MsgId; see `TopicResult` for the meaning of the numbers."""

    sent: int = 0
    delivered: int = 0
    waiting: int = 0
    dropped_limit: int = 0
    dropped_pipe_full: int = 0
    dropped_segment: int = 0
    no_subscriber: int = 0
    held_back: int = 0

    def add(self, other: Traffic) -> None:
        """Add another count of the same MsgId."""
        for each in fields(self):
            setattr(self, each.name, getattr(self, each.name) + getattr(other, each.name))


@dataclass(slots=True)
class RunRecord:
    """Everything that outlives a reset for the sake of the report.

    `history` is by application name, `event_counts` by event type, `errors_by_app` counts ERROR and CRITICAL events:
    the services of each processor write into these three themselves. `topics` has rows of ROS topics by MsgId,
    `invariants` are by name, `deadlines` as in the mission file, with the first `overruns` of each.
    `faults` is the fault injector (`cfepy.faults.FaultInjector`), which has the rows of the report, None without one.
    """

    resets: list[Reset] = field(default_factory=list)
    history: dict[str, AppHistory] = field(default_factory=dict)
    event_counts: dict[int, int] = field(default_factory=dict)
    errors_by_app: dict[str, int] = field(default_factory=dict)
    topics: dict[int, Any] = field(default_factory=dict)
    invariants: dict[str, InvariantRecord] = field(default_factory=dict)
    faults: Any = None
    deadlines: list[Check] = field(default_factory=list)
    overruns: list[Overrun] = field(default_factory=list)
    _traffic: dict[int, Traffic] = field(default_factory=dict)

    def close_books(self, bus: SoftwareBus, topics: Iterable[Any]) -> None:
        """Take down the traffic of a processor that is about to be reset, and the rows of its ROS topics."""
        topics = list(topics)
        self.topics.update((row.msg_id, row) for row in topics)
        for msg_id, count in traffic_of(bus, topics).items():
            self._traffic.setdefault(msg_id, Traffic()).add(count)

    def traffic(self, bus: SoftwareBus, topics: Iterable[Any]) -> dict[int, Traffic]:
        """Traffic by MsgId, in order, with that of the processor that runs now."""
        total = traffic_of(bus, topics)
        for msg_id, count in self._traffic.items():
            total.setdefault(msg_id, Traffic()).add(count)
        return dict(sorted(total.items()))


def traffic_of(bus: SoftwareBus, topics: Iterable[Any] = ()) -> dict[int, Traffic]:
    """Traffic on one bus by MsgId.

    Args:
        bus: the Software Bus.
        topics: the rows of the ROS side (`rospy_shim.graph.TopicRow`), for what only it knows.
    """
    found: dict[int, Traffic] = {}
    for route in bus.routes.values():
        found[route.msg_id] = Traffic(route.sent, *route.totals())
    for msg_id, count in bus.unrouted.sent.items():
        found.setdefault(msg_id, Traffic()).add(Traffic(sent=count, no_subscriber=count))
    for row in topics:
        if row.msg_id in found:
            found[row.msg_id].add(Traffic(dropped_segment=row.dropped, held_back=row.held_back))
    return found
