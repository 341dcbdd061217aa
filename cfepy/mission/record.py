"""The record of a run: the facts of its report, collected over all resets of the processor."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, field, fields
from typing import TYPE_CHECKING, Any, NamedTuple, TypeVar

from cfepy.es import AppHistory
from cfepy.evs import SentError
from cfepy.sb import SoftwareBus

if TYPE_CHECKING:
    from rospy_shim.graph.graph import TopicRow

P = TypeVar("P")


@dataclass(frozen=True, slots=True)
class Reset:
    """A reset of the processor.

    Args:
        at_ns: virtual time.
        reset_type: RST_TYPE_PROCESSOR or RST_TYPE_POWERON.
        reason: the reason and the requester.
        fault: whether a failure caused it; otherwise it was requested.
    """

    at_ns: int
    reset_type: int
    reason: str
    fault: bool


@dataclass(slots=True)
class Traffic:
    """Delivery counts for one MsgId; see `TopicResult` for the meaning of the numbers."""

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


class DataRace(NamedTuple):
    """Two accesses that nothing orders: the time of the second, a description, the application, the task, and an
    identification if the text is not one.
    """

    at_ns: int
    text: str
    detail: str
    app: str
    task: str
    cause: str = ""


class Overwrite(NamedTuple):
    """A write past a block of compiled code, found at the end of the block: the time, the application, a
    description.
    """

    at_ns: int
    app: str
    text: str

    def __str__(self) -> str:
        """Return the text, with the application if there is one."""
        return f"{self.app}: {self.text}" if self.app else self.text


class Leak(NamedTuple):
    """Something that an application held when it ended: the time, the application, a description with the line."""

    at_ns: int
    app: str
    text: str


class StackUse(NamedTuple):
    """The stack use of a compiled task: the maximum bytes used, and the size."""

    used: int
    size: int


@dataclass(slots=True)
class RunRecord:
    """The data of a run that outlive resets, for the report.

    Attachments keep their data in a part of their own. `history` is by application name, `event_counts` by event type.
    `errors_by_app` counts ERROR and CRITICAL events, and `first_errors` has the first of them by application and event
    id. The services of each processor write into these four. `topics` has rows of ROS topics by MsgId. `tables`
    provides more rows for the report, by title; an attachment adds its function there. `data_races` are the races
    found. `overwrites` and `leaks` are the memory errors and the things not given back that the guard found.
    `stack_use` is by application and task, for ended tasks. `traps` are loops that wait without a sleep, and other code
    that works badly on ROS too; their texts are lines of the report.
    """

    resets: list[Reset] = field(default_factory=list)
    history: dict[str, AppHistory] = field(default_factory=dict)
    event_counts: dict[int, int] = field(default_factory=dict)
    errors_by_app: dict[str, int] = field(default_factory=dict)
    first_errors: dict[tuple[str, int], SentError] = field(default_factory=dict)
    topics: dict[int, TopicRow] = field(default_factory=dict)
    tables: dict[str, Callable[[], list[dict[str, Any]]]] = field(default_factory=dict)
    data_races: list[DataRace] = field(default_factory=list)
    overwrites: list[Overwrite] = field(default_factory=list)
    leaks: list[Leak] = field(default_factory=list)
    stack_use: dict[tuple[str, str], StackUse] = field(default_factory=dict)
    traps: list[object] = field(default_factory=list)
    _parts: dict[type, object] = field(default_factory=dict)
    _traffic: dict[int, Traffic] = field(default_factory=dict)

    def note_stack(self, app: str, task: str, used: int, size: int) -> None:
        """Record the stack use of an ended compiled task; for several tasks of the same name, the maximum is kept."""
        before = self.stack_use.get((app, task))
        self.stack_use[app, task] = StackUse(max(used, before.used if before else 0), size)

    def part(self, kind: type[P]) -> P:
        """Return the part of a kind, created without arguments at the first request."""
        found = self._parts.get(kind)
        if not isinstance(found, kind):
            found = self._parts[kind] = kind()
        return found

    def rows(self, title: str) -> list[dict[str, Any]]:
        """Return the rows of a table; empty if there is no such table."""
        table = self.tables.get(title)
        return [] if table is None else table()

    def deaths(self) -> list[str]:
        """Return a line for each application that died: how often, and the last cause."""
        return list(self.deaths_by_app().values())

    def deaths_by_app(self) -> dict[str, str]:
        """Return these lines by the application's name."""
        found = {}
        for app in self.history.values():
            if app.last_error is not None:
                from cfepy.mission.tracebacks import described

                times = "" if app.deaths == 1 else f" {app.deaths} times"
                found[app.name] = f"{app.name} died{times}: {described(app.last_error)}"
        return found

    def close_books(self, bus: SoftwareBus, topics: Iterable[TopicRow]) -> None:
        """Record the traffic of a processor that is about to be reset, and the rows of its ROS topics."""
        topics = list(topics)
        self.topics.update((row.msg_id, row) for row in topics)
        for msg_id, count in traffic_of(bus, topics).items():
            self._traffic.setdefault(msg_id, Traffic()).add(count)

    def traffic(self, bus: SoftwareBus, topics: Iterable[TopicRow]) -> dict[int, Traffic]:
        """Return the traffic by MsgId, sorted, including that of the running processor."""
        total = traffic_of(bus, topics)
        for msg_id, count in self._traffic.items():
            total.setdefault(msg_id, Traffic()).add(count)
        return dict(sorted(total.items()))


def traffic_of(bus: SoftwareBus, topics: Iterable[TopicRow] = ()) -> dict[int, Traffic]:
    """Return the traffic on one bus by MsgId.

    Args:
        bus: the Software Bus.
        topics: the rows of the ROS side (`rospy_shim.graph.graph.TopicRow`), for counts that only it has.
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
