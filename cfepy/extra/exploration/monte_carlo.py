"""The summary of a sweep that draws values: the success rate, the quantiles of the measures, and the worst run.

The runs of each board, rate and varied value are one group. A run succeeds if it is clean, as in every sweep. The
interval of the success rate is Wilson's score interval, which also holds for few runs and for rates near 0 and 1.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from math import sqrt
from statistics import NormalDist
from typing import NamedTuple

from cfepy.extra.exploration.field_measures import LARGEST, SMALLEST
from cfepy.extra.exploration.sweep import SweepRow, seconds_text

CONFIDENCE = 0.95
QUANTILES = (0.05, 0.5, 0.95)


def wilson(successes: int, runs: int, confidence: float = CONFIDENCE) -> tuple[float, float]:
    """Return the confidence interval of a success rate, by Wilson's score.

    Args:
        successes: number of successful runs.
        runs: number of runs, at least 1.
        confidence: probability that such an interval contains the rate.
    """
    z = NormalDist().inv_cdf((1 + confidence) / 2)
    rate, scale = successes / runs, 1 + z * z / runs
    middle = (rate + z * z / (2 * runs)) / scale
    half = z * sqrt(rate * (1 - rate) / runs + (z / (2 * runs)) ** 2) / scale
    # at the ends the interval reaches 0 or 1; rounding must not pass or miss it
    return (max(0.0, middle - half) if successes else 0.0, min(1.0, middle + half) if successes < runs else 1.0)


class Quantity(NamedTuple):
    """The distribution of a measure over the runs of a group.

    Attributes:
        measure: its name.
        unit: its unit; empty if it has none.
        runs: number of runs with a value.
        least, least_run: the smallest value, and the first run with it.
        low, median, high: the quantiles of 5, 50 and 95 %.
        most, most_run: the largest value, and the first run with it.
    """

    measure: str
    unit: str
    runs: int
    least: float
    least_run: int
    low: float
    median: float
    high: float
    most: float
    most_run: int


@dataclass(frozen=True, slots=True)
class Group:
    """The runs of one board, rate and set of varied values.

    Attributes:
        name: board, rate and varied values.
        rows: the runs, by number.
    """

    name: str
    rows: tuple[SweepRow, ...]

    @property
    def failed(self) -> tuple[SweepRow, ...]:
        """The runs that are not clean."""
        return tuple(row for row in self.rows if row.why_not_clean)

    @property
    def successes(self) -> int:
        """The number of clean runs."""
        return len(self.rows) - len(self.failed)

    @property
    def interval(self) -> tuple[float, float]:
        """The confidence interval of the success rate."""
        return wilson(self.successes, len(self.rows))

    @property
    def text(self) -> str:
        """A sentence about the success rate."""
        low, high = self.interval
        runs = f"{self.successes} of {len(self.rows)} runs clean, {self.successes / len(self.rows):.1%}"
        return f"{self.name}: {runs} ({CONFIDENCE:.0%} confidence: {low:.1%} to {high:.1%})"

    def quantities(self) -> list[Quantity]:
        """Return the distribution of each measure; runs without a value do not count."""
        import numpy

        columns: dict[tuple[str, str], list[tuple[float, int]]] = {}
        for row in self.rows:
            for measure, unit, value in measured(row):
                columns.setdefault((measure, unit), []).append((value, row.point.run or 0))
        found = []
        for (measure, unit), pairs in columns.items():
            least, most = min(pairs), min(pairs, key=lambda pair: (-pair[0], pair[1]))
            low, median, high = map(float, numpy.quantile([value for value, _ in pairs], QUANTILES))
            found.append(Quantity(measure, unit, len(pairs), *least, low, median, high, *most))
        return found

    def worst(self) -> tuple[SweepRow, str]:
        """Return the worst run and the reason.

        A run that is not clean is worse than a clean one: first those with a problem, then those with the most lost
        messages, then those with the lowest share of the requested rate. Of clean runs the worst has the largest `max`
        or the smallest `min` value of the first such measured field, or else the longest latency. Of equal runs it is
        the first.
        """
        row = max(self.rows, key=lambda each: (_badness(each), -(each.point.run or 0), -each.point.seed))
        return row, row.why_not_clean or _why_worst(row)


def groups_of(rows: Sequence[SweepRow]) -> list[Group]:
    """Return the groups of a sweep's drawn runs, in their order."""
    found: dict[str, list[SweepRow]] = {}
    for row in rows:
        rate = [] if row.point.rate_hz is None else [f"{row.point.rate_hz:g} Hz"]
        parts = [row.numbers.board, *rate, *(f"{name}={value}" for name, value in row.varied)]
        found.setdefault(", ".join(filter(None, parts)), []).append(row)
    return [Group(name, tuple(each)) for name, each in found.items()]


def measured(row: SweepRow) -> Iterator[tuple[str, str, float]]:
    """Yield the measures of a run, with their units: of its fields, of its topics with messages, and the CPU."""
    for field in row.numbers.values:
        if field.value is not None:
            yield field.name, field.unit, field.value
    for topic in row.numbers.sent:
        yield f"{topic.name} rate", "Hz", topic.delivered_hz
        yield f"{topic.name} lost", "", topic.lost
        yield f"{topic.name} longest latency", "us", topic.latency_max_us
    if row.numbers.trace:
        yield "CPU", "%", round(row.numbers.cpu * 100, 7)


def _badness(row: SweepRow) -> tuple[bool, bool, int, float, float, float]:
    numbers, asked = row.numbers, row.point.rate_hz
    lost = sum(topic.lost for topic in numbers.topics)
    share = min((topic.delivered_hz / asked for topic in numbers.topics), default=0.0) if asked else 1.0
    has_problem = bool(numbers.problem or numbers.trouble)
    return bool(row.why_not_clean), has_problem, lost, -share, _extreme(row), _latency_us(row)


def _latency_us(row: SweepRow) -> float:
    return max((topic.latency_max_us for topic in row.numbers.sent), default=0.0)


def _extreme(row: SweepRow) -> float:
    """Return the first measured `max` value, or `min` value with the other sign; 0 without any."""
    for field in row.numbers.values:
        kind = field.name.partition(":")[0]
        if field.value is not None and kind in (LARGEST, SMALLEST):
            return field.value if kind == LARGEST else -field.value
    return 0.0


def _why_worst(row: SweepRow) -> str:
    for field in row.numbers.values:
        if field.value is not None and field.name.partition(":")[0] in (LARGEST, SMALLEST):
            return f"clean, with {field.name} = {field.value:.6g}{f' {field.unit}' if field.unit else ''}"
    return f"clean, with a latency of {seconds_text(_latency_us(row))}" if row.numbers.sent else "clean"
