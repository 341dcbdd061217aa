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
        reason: why, and at whose request.
        fault: it followed from a failure, and was not asked for.
    """

    at_ns: int
    reset_type: int
    reason: str
    fault: bool


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


class DataRace(NamedTuple):
    """Two accesses that nothing orders: when the second came, what is told, of whom, in which task; what tells it from
    others, where the text does not.
    """

    at_ns: int
    text: str
    detail: str
    app: str
    task: str
    cause: str = ""


class Overwrite(NamedTuple):
    """A block of compiled code that was written past, found when it was over: when that was, of whom, what is told."""

    at_ns: int
    app: str
    text: str

    def __str__(self) -> str:
        """The text, with the application if it is one's."""
        return f"{self.app}: {self.text}" if self.app else self.text


class StackUse(NamedTuple):
    """How many bytes of its stack a compiled task has used at most, and how many it has."""

    used: int
    size: int


@dataclass(slots=True)
class RunRecord:
    """Everything that outlives a reset for the sake of the report.

    Attachments keep what they have to tell in a part of their own. `history` is by application name, `event_counts` by
    event type, `errors_by_app` counts ERROR and CRITICAL events, `first_errors` has the first of them by application
    and event id: the services of each processor write into these four themselves. `topics` has rows of ROS topics by
    MsgId. `tables` gives further rows for the report, by their title there; an attachment that has some puts a function
    here. `data_races` are those that were found, `overwrites` what the guard found in its memory. `stack_use` is by
    application and task, of tasks that have ended.
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
    stack_use: dict[tuple[str, str], StackUse] = field(default_factory=dict)
    _parts: dict[type, object] = field(default_factory=dict)
    _traffic: dict[int, Traffic] = field(default_factory=dict)

    def note_stack(self, app: str, task: str, used: int, size: int) -> None:
        """A compiled task has ended; of several that had its name the deepest use stays."""
        before = self.stack_use.get((app, task))
        self.stack_use[app, task] = StackUse(max(used, before.used if before else 0), size)

    def part(self, kind: type[P]) -> P:
        """The part of a kind, made without arguments when it is first asked for."""
        found = self._parts.get(kind)
        if not isinstance(found, kind):
            found = self._parts[kind] = kind()
        return found

    def rows(self, title: str) -> list[dict[str, Any]]:
        """The rows of a table; none when there is no such table."""
        table = self.tables.get(title)
        return [] if table is None else table()

    def deaths(self) -> list[str]:
        """A line for each application that died: how often, and of what at last."""
        return list(self.deaths_by_app().values())

    def deaths_by_app(self) -> dict[str, str]:
        """The same by the application's name."""
        found = {}
        for app in self.history.values():
            if app.last_error is not None:
                from cfepy.mission.tracebacks import described

                times = "" if app.deaths == 1 else f" {app.deaths} times"
                found[app.name] = f"{app.name} died{times}: {described(app.last_error)}"
        return found

    def close_books(self, bus: SoftwareBus, topics: Iterable[TopicRow]) -> None:
        """Take down the traffic of a processor that is about to be reset, and the rows of its ROS topics."""
        topics = list(topics)
        self.topics.update((row.msg_id, row) for row in topics)
        for msg_id, count in traffic_of(bus, topics).items():
            self._traffic.setdefault(msg_id, Traffic()).add(count)

    def traffic(self, bus: SoftwareBus, topics: Iterable[TopicRow]) -> dict[int, Traffic]:
        """Traffic by MsgId, in order, with that of the processor that runs now."""
        total = traffic_of(bus, topics)
        for msg_id, count in self._traffic.items():
            total.setdefault(msg_id, Traffic()).add(count)
        return dict(sorted(total.items()))


def traffic_of(bus: SoftwareBus, topics: Iterable[TopicRow] = ()) -> dict[int, Traffic]:
    """Traffic on one bus by MsgId.

    Args:
        bus: the Software Bus.
        topics: the rows of the ROS side (`rospy_shim.graph.graph.TopicRow`), for what only it knows.
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
