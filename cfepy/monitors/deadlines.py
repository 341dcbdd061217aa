"""Deadlines: how fast applications must respond, how fresh topics must be, and the measured values.

They are defined in the section `deadlines:` of a mission file. A `Check` counts measurements and overruns, and keeps
the worst value. `cfepy.monitors.deadline_monitor` does the measuring.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import dataclass
from functools import partial
from typing import NamedTuple

from cfepy.msg import is_valid_msg_id
from cfepy.reading.marked_yaml import Marked
from cfepy.reading.mistakes import Mistakes
from cfepy.reading.suggestions import listed
from cfepy.units import NS_PER_S, TIME_UNITS, instant_text, time_text

PARTS = ("apps", "topics")
APP_FIELDS = ("response", "period", "jitter", "task")
TOPIC_FIELDS = ("latency", "at_least_every", "at_most_every")
LONGEST_NS = 1_000_000 * NS_PER_S
TIME = re.compile(r"\s*(\d+(?:\.\d*)?|\.\d+)\s*(ns|us|ms|s|Hz)\s*")


@dataclass(frozen=True, slots=True)
class AppDeadline:
    """Deadlines of an application.

    Attributes:
        app: its cFE name.
        response_ns: longest time from the end of a wait of one of its tasks to the start of the next; None for no
            limit.
        period_ns: time from one end of a wait to the next, for the main task or `task`; None for no limit.
        jitter_ns: allowed deviation from the period.
        task: name of the only task to check; None checks the response of all tasks and the period of the main task.
    """

    app: str
    response_ns: int | None = None
    period_ns: int | None = None
    jitter_ns: int = 0
    task: str | None = None


@dataclass(frozen=True, slots=True)
class TopicDeadline:
    """Deadlines of a topic or another message.

    Attributes:
        name: the topic, a packet's name, or a MsgId as "0x0883".
        latency_ns: longest time from sending until a receiver has it; None for no limit.
        longest_ns: longest time from one message to the next; None for no limit.
        shortest_ns: shortest time from one message to the next; None for no limit.
    """

    name: str
    latency_ns: int | None = None
    longest_ns: int | None = None
    shortest_ns: int | None = None

    @property
    def msg_id(self) -> int | None:
        """The MsgId, if it is given as a number."""
        return int(self.name, 16) if self.name.startswith("0x") else None


@dataclass(frozen=True, slots=True)
class Deadlines:
    """All deadlines of a mission; false if there are none."""

    apps: tuple[AppDeadline, ...] = ()
    topics: tuple[TopicDeadline, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.apps or self.topics)


def read_deadlines(section: Marked, mistakes: Mistakes) -> Deadlines:
    """Return the section `deadlines:`, without invalid entries.

    Args:
        section: its value.
        mistakes: collects unknown keys and invalid values.
    """
    parts = dict(mistakes.fields(section, PARTS))
    apps = mistakes.mapping(parts["apps"]) if "apps" in parts else {}
    topics = mistakes.mapping(parts["topics"]) if "topics" in parts else {}
    of_apps = [mistakes.whole(partial(_app_deadline, name, entry)) for name, entry in apps.items()]
    of_topics = [mistakes.whole(partial(_topic_deadline, name, entry)) for name, entry in topics.items()]
    return Deadlines(
        tuple(each for each in of_apps if each is not None), tuple(each for each in of_topics if each is not None)
    )


def _app_deadline(app: str, entry: Marked, mistakes: Mistakes) -> AppDeadline:
    fields = dict(mistakes.fields(entry, APP_FIELDS))
    if not mistakes.errors:  # otherwise a field is missing because its name is wrong
        _check_combination(entry, fields, mistakes)
    return AppDeadline(
        app,
        response_ns=mistakes.attempt(partial(_time, fields.get("response"))),
        period_ns=mistakes.attempt(partial(_time, fields.get("period"))),
        jitter_ns=mistakes.attempt(partial(_jitter, fields.get("jitter"))) or 0,
        task=mistakes.attempt(fields["task"].text) if "task" in fields else None,
    )


def _check_combination(entry: Marked, fields: Mapping[str, Marked], mistakes: Mistakes) -> None:
    if "response" not in fields and "period" not in fields:
        mistakes.add(entry.fail("missing response or period; add one, such as `response: 2 ms`"))
    elif "jitter" in fields and "period" not in fields:
        mistakes.add(fields["jitter"].fail("requires a period; add it, such as `period: 10 ms`"))
    elif "period" in fields and "jitter" not in fields:
        mistakes.add(entry.fail("missing jitter of the period; add it, such as `jitter: 1 ms`"))


def _topic_deadline(name: str, entry: Marked, mistakes: Mistakes) -> TopicDeadline:
    fields = dict(mistakes.fields(entry, TOPIC_FIELDS))
    if not fields and not mistakes.errors:
        raise entry.fail(f"requires {listed(TOPIC_FIELDS)}, such as `latency: 5 ms`")
    if name.startswith("0x"):
        mistakes.attempt(partial(_check_msg_id, name, entry))
    found = TopicDeadline(name, *(mistakes.attempt(partial(_time, fields.get(each))) for each in TOPIC_FIELDS))
    if found.longest_ns is not None and found.shortest_ns is not None and found.longest_ns < found.shortest_ns:
        raise fields["at_least_every"].fail("must not be shorter than at_most_every")
    return found


def _check_msg_id(name: str, entry: Marked) -> None:
    try:
        is_good = is_valid_msg_id(int(name, 16))
    except ValueError:
        is_good = False
    if not is_good:
        raise entry.fail("is not a MsgId; write one such as 0x0883, or the name of a topic or packet")


def _jitter(entry: Marked | None) -> int:
    return _time(entry, zero=True) or 0


def _time(entry: Marked | None, zero: bool = False) -> int | None:
    """Return a time with its unit, in ns.

    Raises:
        UsageError: if the text is not a time with a unit.
    """
    if entry is None:
        return None
    match = TIME.fullmatch(entry.value) if isinstance(entry.value, str) else None
    if match is None:
        raise entry.fail(f"must be a time with a unit, such as 500 us, 2.5 ms, 1 s or 50 Hz, not {entry.shown()}")
    number, unit = float(match[1]), match[2]
    found = round(number * TIME_UNITS[unit]) if unit in TIME_UNITS else round(NS_PER_S / max(number, 1e-9))
    if not (0 if zero else 1) <= found <= LONGEST_NS:
        raise entry.fail(f"must be from {0 if zero else 1} ns to {LONGEST_NS // NS_PER_S} s, not {entry.value}")
    return found


def limits_of(deadline: AppDeadline | TopicDeadline) -> Mapping[str, int]:
    """Return the limits of a deadline in ns, by their names in the mission file."""
    if isinstance(deadline, AppDeadline):
        named = {"response": deadline.response_ns, "period": deadline.period_ns}
    else:
        named = dict(zip(TOPIC_FIELDS, (deadline.latency_ns, deadline.longest_ns, deadline.shortest_ns), strict=True))
    return {name: limit for name, limit in named.items() if limit is not None}


class Overrun(NamedTuple):
    """An overrun: time in virtual ns, owner, kind and description."""

    at_ns: int
    owner: str
    kind: str
    text: str


@dataclass(frozen=True, slots=True)
class DeadlineResult:
    """Report of one deadline. Times in virtual s.

    Attributes:
        owner: an application, topic or packet.
        kind: as in the mission file, such as "response".
        limit_s: its limit; for a period, the period itself.
        jitter_s: for a period; 0 for others.
        checked: number of measurements.
        overruns: number of overruns.
        worst_s: worst measured value; None without measurement.
        first_at_s: time of the first overrun; None if there was none.
    """

    owner: str
    kind: str
    limit_s: float
    jitter_s: float
    checked: int
    overruns: int
    worst_s: float | None
    first_at_s: float | None

    @property
    def limit_text(self) -> str:
        """The limit for display: "10 ms +- 1 ms"."""
        limit = time_text(round(self.limit_s * NS_PER_S))
        return f"{limit} +- {time_text(round(self.jitter_s * NS_PER_S))}" if self.kind == "period" else limit

    @property
    def problem(self) -> str | None:
        """Return a line that describes the overruns; None if there were none."""
        if not self.overruns or self.worst_s is None or self.first_at_s is None:
            return None
        times = f"{self.overruns} time{'s' if self.overruns > 1 else ''}"
        worst = time_text(round(self.worst_s * NS_PER_S))
        at = f"first at {instant_text(round(self.first_at_s * NS_PER_S))}"
        return f"{self.owner} missed its deadline {self.kind} {self.limit_text} {times}, at worst with {worst}, {at}"


@dataclass(slots=True)
class Check:
    """One limit and its measurements so far; times in ns."""

    owner: str
    kind: str
    limit_ns: int
    jitter_ns: int = 0
    checked: int = 0
    worst_ns: int | None = None
    overruns: int = 0
    first_at_ns: int | None = None

    def measure(self, measured_ns: int) -> bool:
        """Add a measurement; returns whether it is within the limit."""
        self.checked += 1
        self.saw(measured_ns)
        if self.kind == "period":
            return abs(measured_ns - self.limit_ns) <= self.jitter_ns
        if self.kind == "at_most_every":
            return measured_ns >= self.limit_ns
        return measured_ns <= self.limit_ns

    def saw(self, measured_ns: int) -> None:
        """Update the worst value."""
        if self.worst_ns is None or self._badness(measured_ns) > self._badness(self.worst_ns):
            self.worst_ns = measured_ns

    def _badness(self, measured_ns: int) -> int:
        if self.kind == "period":
            return abs(measured_ns - self.limit_ns)
        return -measured_ns if self.kind == "at_most_every" else measured_ns

    def result(self) -> DeadlineResult:
        """Return the report."""
        worst = None if self.worst_ns is None else self.worst_ns / NS_PER_S
        first = None if self.first_at_ns is None else self.first_at_ns / NS_PER_S
        limit, jitter = self.limit_ns / NS_PER_S, self.jitter_ns / NS_PER_S
        return DeadlineResult(self.owner, self.kind, limit, jitter, self.checked, self.overruns, worst, first)
