"""A sweep: a mission flown at many points, which differ in board, rate, parameters and seed, with the results of each.

A point is a change of a `RunPlan`, so each has a command that flies it alone. The results are virtual times and counts,
so a sweep gives the same numbers on any number of processes. The knee is the highest rate up to which all sent messages
arrived, at the requested rate.
"""

from __future__ import annotations

import re
import traceback
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

from cfepy.extra.exploration.batch import Lot
from cfepy.extra.exploration.draws import Drawn
from cfepy.extra.exploration.field_measures import FieldMeasure, FieldValue, recorder_of
from cfepy.extra.exploration.mission_transfer import PlanElsewhere
from cfepy.monitors import Arrivals, TrafficWatch
from cfepy.pilot import BootError, Results, RunPlan, SentNames, fly
from cfepy.status import UsageError
from cfepy.units import NS_PER_S

RATE_TOLERANCE = 0.01  # of the requested rate: the precision of a run of some seconds
_US = 1000.0  # ns


class Point(NamedTuple):
    """One run of a sweep.

    Attributes:
        board: name or file; None for the mission's own.
        rate_hz: the rate of `--rate`; None without it.
        settings: parameters and their values, including the parameters of the rate.
        launch_args: arguments of the launch file.
        seed: seed of all random values.
        run: number of the run of a sweep that draws values, from 0; None in another sweep.
        drawn: the drawn values of the run; they are among the settings and the arguments too.
    """

    board: str | None = None
    rate_hz: float | None = None
    settings: tuple[tuple[str, str], ...] = ()
    launch_args: tuple[tuple[str, str], ...] = ()
    seed: int = 0
    run: int | None = None
    drawn: Drawn = ()

    def plan(self, base: RunPlan) -> RunPlan:
        """Return the run of this point."""
        board = self.board
        if board is not None and board.startswith("/") and isinstance(base, PlanElsewhere):
            board = base.root + board
        return replace(
            base,
            board=board,
            seed=self.seed,
            settings=(*base.settings, *self.settings),
            launch_args=(*base.launch_args, *self.launch_args),
        )


@dataclass(frozen=True, slots=True)
class TopicNumbers:
    """Delivery figures of one topic. With several subscribers, the figures of the slowest one.

    Attributes:
        name: of the topic or packet.
        sent, lost, received: messages, from half a second after the mission was OPERATIONAL; a `lost` message was
            refused by a pipe, or was dropped for a newer one.
        held_back: messages that a publisher could send only later, over the whole run.
        delivered_hz: rate at which the subscriber took them.
        latency_mean_us, latency_max_us: virtual time from the sending of a message to its taking.
        hint: the end of a sentence about a topic without messages.
    """

    name: str
    sent: int
    received: int
    lost: int
    held_back: int
    delivered_hz: float
    latency_mean_us: float
    latency_max_us: float
    hint: str = ""


@dataclass(frozen=True, slots=True)
class PointNumbers:
    """The results of a point.

    Attributes:
        board: the board's name.
        cpu: share of the virtual time that applications used, 0 to 1.
        ram_peak, ram: peak use and size of the RAM in bytes; None without a limit.
        topics: the measured topics, in their order.
        problem: the first problem of the run; empty for none.
        trace: digest of the run.
        trouble: traceback of an error of cfepy itself, which is not an error of the mission.
        values: the measured values of fields, in their order.
        loose_end: the first topic that connects to nothing, as a run reports it; empty for none.
    """

    board: str = ""
    cpu: float = 0.0
    ram_peak: int = 0
    ram: int | None = None
    topics: tuple[TopicNumbers, ...] = ()
    problem: str = ""
    trace: str = ""
    trouble: str = ""
    values: tuple[FieldValue, ...] = ()
    loose_end: str = ""

    @property
    def sent(self) -> tuple[TopicNumbers, ...]:
        """The topics with messages: one without any has no rate, and is not the slowest."""
        return tuple(each for each in self.topics if each.sent)

    def why_not_clean(self, rate_hz: float | None, needs_messages: bool = True) -> str:
        """Return why a rate is not clean; empty if it is.

        Args:
            rate_hz: the requested rate; None if there is none, and only losses count.
            needs_messages: whether a run without any measured topic is not clean.
        """
        if self.problem or self.trouble:
            return self.problem or self.trouble.splitlines()[-1]
        for topic in self.topics:
            if not topic.sent:
                return f"no message of {topic.name} was measured{topic.hint}"
            if topic.lost:
                return f"{topic.name} lost {topic.lost} of {topic.sent}"
            if rate_hz is not None and topic.delivered_hz < rate_hz * (1 - RATE_TOLERANCE):
                held = f", {topic.held_back} were held back" if topic.held_back else ""
                return f"{topic.name} came at {topic.delivered_hz:.1f} Hz{held}"
        unmeasured = next((each for each in self.values if each.value is None), None)
        if unmeasured is not None:
            return f"no value of {unmeasured.name}: {unmeasured.why}"
        if self.topics or self.values or not needs_messages:
            return ""
        return f"no message came; {self.loose_end}" if self.loose_end else "no message came"


@dataclass(frozen=True, slots=True)
class Sweep(Lot[Point, PointNumbers]):
    """Flies points.

    Attributes:
        plan: the settings that all points share.
        topics: names of the topics that are measured; empty for all ROS topics with messages.
        fields: the fields that are measured.
    """

    plan: RunPlan
    topics: tuple[str, ...] = ()
    fields: tuple[FieldMeasure, ...] = ()

    def judge(self, subject: Point) -> PointNumbers:
        watch, recorded = TrafficWatch(), recorder_of(self.fields)
        try:
            flown = fly(subject.plan(self.plan), attachments=[watch, *recorded])
        except (BootError, UsageError) as error:
            return PointNumbers(board=subject.board or "", problem=str(error).splitlines()[0])
        except Exception:
            return PointNumbers(board=subject.board or "", trouble=traceback.format_exc())
        results = flown.results
        return PointNumbers(
            results.board,
            round(sum(app.cpu_share for app in results.apps), 9),
            results.memory.peak,
            results.memory.limit,
            tuple(self._numbers(results, watch, SentNames(flown.mission))),
            _first_problem(results),
            flown.trace,
            values=tuple(each.value_in(recorded[0]) for each in self.fields),
            loose_end=next(iter(results.loose_ends), ""),
        )

    def died(self, subject: Point, fate: str, words: str) -> PointNumbers:
        return PointNumbers(board=subject.board or "", problem=f"the process died: {fate}")

    def _numbers(self, results: Results, watch: TrafficWatch, sent: SentNames) -> Iterator[TopicNumbers]:
        by_name = {topic.name: topic for topic in results.topics}
        if self.topics:
            names = list(self.topics)
        else:
            names = [
                each.name
                for each in results.topics
                if "/" in each.type and watch.arrivals.get(each.msg_id) and watch.sent[each.msg_id]
            ]
        for name in names:
            topic = by_name.get(name)
            if topic is None:
                hint = sent.why_not([name]) or _loose_end_of(name, results.loose_ends)
                yield TopicNumbers(name, 0, 0, 0, 0, 0.0, 0.0, 0.0, hint)
                continue
            pipes = list(watch.arrivals.get(topic.msg_id, {}).values()) or [Arrivals()]
            count = sum(each.count for each in pipes)
            yield TopicNumbers(
                name,
                watch.sent[topic.msg_id],
                min(each.count for each in pipes),
                watch.lost[topic.msg_id] + topic.dropped_segment,
                topic.held_back,
                round(min(each.rate_hz(watch.end_ns) for each in pipes), 3),
                round(sum(each.latency_ns for each in pipes) / count / _US, 3) if count else 0.0,
                round(max(each.longest_ns for each in pipes) / _US, 3),
                "" if watch.sent[topic.msg_id] else _loose_end_of(name, results.loose_ends),
            )


def _loose_end_of(name: str, loose_ends: Sequence[str]) -> str:
    """Return the end of a sentence about a topic without messages: why it connects to nothing; empty if it does."""
    named = re.compile(rf"(?<!\S){re.escape(name)}(?![\w/])")
    return next((f"; {each}" for each in loose_ends if named.search(each)), "")


def _first_problem(results: Results) -> str:
    return next(iter(results.problems), "")


class Knee(NamedTuple):
    """The highest rate at which a board carries a mission.

    Attributes:
        board: its name.
        varied: other values that distinguish the points, such as a parameter.
        clean_hz: the highest rate with all lower ones clean; None if not even the lowest is.
        broken_hz: the first rate that is not clean; None if all are.
        why: the problem at that rate.
    """

    board: str
    varied: tuple[tuple[str, str], ...]
    clean_hz: float | None
    broken_hz: float | None
    why: str

    @property
    def text(self) -> str:
        """A sentence about the knee."""
        where = ", ".join([self.board, *(f"{name}={value}" for name, value in self.varied)])
        clean = "not clean at any rate" if self.clean_hz is None else f"clean up to {self.clean_hz:g} Hz"
        if self.broken_hz is None:
            return f"{where}: {clean}, the highest rate that was flown"
        return f"{where}: {clean}; at {self.broken_hz:g} Hz {self.why}"


class SweepRow(NamedTuple):
    """A point, its results, and the varied values other than board, rate and seed."""

    point: Point
    numbers: PointNumbers
    varied: tuple[tuple[str, str], ...]

    @property
    def why_not_clean(self) -> str:
        """Why the point is not clean; see `PointNumbers.why_not_clean`."""
        return self.numbers.why_not_clean(self.point.rate_hz, needs_messages=self.point.run is None)


def knees(rows: Sequence[SweepRow]) -> list[Knee]:
    """Return the knee of each board and each varied value. A rate is clean if it is clean under all seeds.

    Args:
        rows: of a sweep; rows without a rate have no knee.
    """
    groups: dict[tuple[str, tuple[tuple[str, str], ...]], dict[float, str]] = {}
    for row in rows:
        if row.point.rate_hz is not None:
            by_rate = groups.setdefault((row.numbers.board, row.varied), {})
            by_rate[row.point.rate_hz] = by_rate.get(row.point.rate_hz, "") or row.why_not_clean
    return [_knee(board, varied, by_rate) for (board, varied), by_rate in groups.items()]


def _knee(board: str, varied: tuple[tuple[str, str], ...], by_rate: dict[float, str]) -> Knee:
    clean: float | None = None
    for rate, why in sorted(by_rate.items()):
        if why:
            return Knee(board, varied, clean, rate, why)
        clean = rate
    return Knee(board, varied, clean, None, "")


COLUMNS = (
    *("board", "rate_hz", "seed", "topic", "sent", "received", "lost", "held_back", "delivered_hz"),
    *("latency_mean_us", "latency_max_us", "cpu", "ram_peak_bytes", "clean", "problem", "trace"),
)
"""The columns of a table of points, with a row for each topic of each point.

After `seed` come the other varied values, and at the end the measured fields. A sweep that draws begins with the
number of the run.
"""


def sweep_table(rows: Sequence[SweepRow]) -> tuple[list[str], list[list[Any]]]:
    """Return a sweep as a table: heads, and a row for each topic of each point, in the order of the points."""
    names = list(dict.fromkeys(name for row in rows for name, _ in (*row.varied, *row.point.drawn)))
    fields = list(dict.fromkeys(each.name for row in rows for each in row.numbers.values))
    is_drawn = any(row.point.run is not None for row in rows)
    heads = [*(["run"] if is_drawn else []), *COLUMNS[:3], *names, *COLUMNS[3:], *fields]
    found = []
    for row in rows:
        measured = {each.name: each.value for each in row.numbers.values}
        begin, end = [row.point.run] if is_drawn else [], [measured.get(name, "") for name in fields]
        found += [[*begin, *_cells(row, topic, names), *end] for topic in row.numbers.topics or (None,)]
    return heads, found


def _cells(row: SweepRow, topic: TopicNumbers | None, names: Sequence[str]) -> list[Any]:
    point, numbers, varied = row.point, row.numbers, dict((*row.varied, *row.point.drawn))
    of_topic: list[Any] = [""] * 8
    if topic is not None:
        of_topic = [topic.name, topic.sent, topic.received, topic.lost, topic.held_back, topic.delivered_hz]
        of_topic += [topic.latency_mean_us, topic.latency_max_us]
    rate = "" if point.rate_hz is None else f"{point.rate_hz:g}"
    why = row.why_not_clean
    of_run = [f"{numbers.cpu:.9f}", numbers.ram_peak, "no" if why else "yes", why, numbers.trace]
    return [numbers.board, rate, point.seed, *(varied.get(name, "") for name in names), *of_topic, *of_run]


def seconds_text(time_us: float) -> str:
    """Return a time as text: in us, or in ms from 1 ms on."""
    return f"{time_us:.0f} us" if time_us < _US else f"{time_us * _US / NS_PER_S * 1000:.2f} ms"
