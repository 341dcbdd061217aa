"""Values over time on the page: the data that its script draws when a reader selects a field, and the selection.

Fields are drawn in groups: the items of an array, or the members of a struct. The points of a series are thinned to
some hundred pairs: of each interval of messages the lowest and the highest value. Their times are whole microseconds,
and their values 16-bit steps between the lowest and the highest, in base64. So a field takes some two kilobytes,
regardless of the length of the run. If all fields together would take more than `MOST_BYTES`, they get fewer points,
and then the fields of the largest messages are left out.
"""

from __future__ import annotations

import re
from base64 import b64encode
from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

from cfepy.extra.reports.curves import Curve, Curves, curves_of
from cfepy.extra.reports.html_text import section, table
from cfepy.extra.reports.page_story import instant
from cfepy.ground import Series, SeriesSet, steps_of, value_at
from cfepy.msg import RED, YELLOW
from cfepy.status import UsageError
from cfepy.units import NS_PER_S
from cfepy.writing.markup import element, escaped

if TYPE_CHECKING:
    from numpy.typing import NDArray

MOST_BYTES = 1_500_000
MOST_PAIRS, FEWEST_PAIRS = 400, 60
BYTES_OF_A_PAIR = 2 * 2 * 4 / 3  # of a field: two values of two bytes, as base64
STEPS = 65_534
MISSING = 65_535
US_PER_S = 1_000_000
_ITEM = re.compile(r"(\[\d+\])+$")


class ValueData(NamedTuple):
    """The embedded values, as plain data for JSON, and the number of shown fields and of all fields."""

    plain: list[dict[str, Any]]
    shown: int
    found: int


def value_data(recorded: SeriesSet) -> ValueData:
    """Make the embedded values of a run.

    Args:
        recorded: all topics and packets.
    """
    found = [curves for name in recorded.names for curves in _curves(recorded, name)]
    count = sum(len(curves.lines) for curves in found)
    pairs = max(FEWEST_PAIRS, min(MOST_PAIRS, int(MOST_BYTES / BYTES_OF_A_PAIR / max(1, count))))
    room = left = int(MOST_BYTES / BYTES_OF_A_PAIR / pairs)
    chosen: dict[str, dict[str, Any]] = {}
    for curves in sorted(found, key=lambda each: len(each.lines)):
        lines = curves.lines[:left]
        left -= len(lines)
        if lines or curves.changes:
            chosen[curves.name] = _series(recorded.series(curves.name), curves, lines, pairs)
    return ValueData([chosen[name] for name in sorted(chosen)], room - left, count)


def _curves(recorded: SeriesSet, name: str) -> list[Curves]:
    """Return the curves of a topic or packet that can be drawn."""
    try:
        return curves_of(recorded, name)
    except UsageError:  # it cannot be drawn, or its bytes are not a message of its type
        return []


def _series(series: Series, curves: Curves, lines: Sequence[Curve], pairs: int) -> dict[str, Any]:
    bins = TimeBins.of(curves.lines[0].times if curves.lines else series.times, pairs)
    groups: dict[str, list[Curve]] = {}
    for line in lines:
        groups.setdefault(_group(line.label), []).append(line)
    return {
        "name": series.name,
        "type": series.type,
        "count": series.count,
        "every": series.every,
        "times": bins.times_us(),
        "groups": [
            {
                "name": name,
                "unit": series.unit(_path(members[0].label)),
                "limits": _limits(series, members),
                "lines": [{"name": line.label, **encoded(bins.thinned(line.values))} for line in members],
            }
            for name, members in groups.items()
        ],
        "changes": [[round(change.time * US_PER_S), change.text] for change in curves.changes],
    }


def _limits(series: Series, members: Sequence[Curve]) -> list[list[str | float]]:
    """Return the limits of a group of lines that has one field, or an array of equal measurements."""
    measured = {series.measured.get(line.label) for line in members}
    found = measured.pop() if len(measured) == 1 else None
    limits = [] if found is None else [(name, limit) for name in (YELLOW, RED) for limit in found.limits(name)]
    return [[name, limit] for name, limit in limits if limit is not None]


def _path(label: str) -> str:
    return label.partition(" ")[0]


def _group(label: str) -> str:
    """Return the group of a line: `position` for position[2], `pose.position` for pose.position.x."""
    path = _path(label)
    array = _ITEM.sub("", path)
    return array if array != path else path.rpartition(".")[0] or path


class TimeBins(NamedTuple):
    """Intervals of a series that become two points each; None if the series is short enough."""

    times: NDArray[Any]
    starts: NDArray[Any] | None

    @classmethod
    def of(cls, times: NDArray[Any], pairs: int) -> TimeBins:
        """Make at most `pairs` intervals with equal numbers of messages."""
        import numpy

        if len(times) <= 2 * pairs:
            return cls(times, None)
        return cls(times, numpy.linspace(0, len(times), pairs, endpoint=False).astype(int))

    def times_us(self) -> list[int]:
        """Return the times of the points in us, each as the distance from the previous one."""
        import numpy

        times = self.times
        if self.starts is not None:
            ends = numpy.append(self.starts[1:], len(times))
            times = times[numpy.column_stack((self.starts, (self.starts + ends) // 2)).ravel()]
        steps: list[int] = numpy.diff(numpy.round(times * US_PER_S).astype(numpy.int64), prepend=0).tolist()
        return steps

    def thinned(self, values: NDArray[Any]) -> NDArray[Any]:
        """Return the lowest and the highest value of each interval, in the direction from its first to its last
        value.
        """
        import numpy

        if self.starts is None:
            return values
        lows, highs = numpy.fmin.reduceat(values, self.starts), numpy.fmax.reduceat(values, self.starts)
        lasts = values[numpy.append(self.starts[1:], len(values)) - 1]
        rises = values[self.starts] <= lasts
        return numpy.column_stack((numpy.where(rises, lows, highs), numpy.where(rises, highs, lows))).ravel()


def encoded(values: NDArray[Any]) -> dict[str, Any]:
    """Encode values as `low`, `step` and `data`: base64 of 16-bit little-endian numbers of steps above the lowest
    value.

    Whole numbers in a narrow range are exact. A value that is missing or not finite is `MISSING`; a constant has no
    `data`.
    """
    import numpy

    is_there = numpy.isfinite(values)
    if not is_there.any():
        return {"low": 0.0, "step": 0.0, "data": _base64(numpy.full(len(values), MISSING))}
    low, high = float(values[is_there].min()), float(values[is_there].max())
    if low == high and is_there.all():
        return {"low": low}
    is_whole = high - low <= STEPS and bool((values[is_there] == numpy.round(values[is_there])).all())
    step = 1.0 if is_whole else (high - low) / STEPS or 1.0
    steps = numpy.where(is_there, numpy.round((numpy.where(is_there, values, low) - low) / step), MISSING)
    return {"low": low, "step": step, "data": _base64(steps)}


def _base64(steps: NDArray[Any]) -> str:
    return b64encode(steps.astype("<u2").tobytes()).decode()


# -- the section of the page ------------------------------------------------------------------------------------------


def values_section(values: ValueData, recorded: SeriesSet) -> str:
    """Return the section in which a reader selects fields; empty if no message was sent."""
    if not values.plain:
        return ""
    picker = element("div", "", id="values-fields", class_="fields", role="group", aria_label="Fields to draw")
    canvas = element(
        "canvas",
        "",
        id="values-canvas",
        tabindex="0",
        role="img",
        aria_label="The selected fields by virtual time; cfepy export writes them as a table",
    )
    tip = element("p", "Select fields to draw them.", id="values-tip", class_="tip", aria_live="off")
    search = element("input", type="search", id="values-filter", autocomplete="off").removesuffix("</input>")
    search = element("label", "Show fields that contain", for_="values-filter") + search
    drawn = element("div", element("div", canvas, class_="timeline") + tip, class_="drawn")
    about = (
        "Fields of topics and packets over the time range of the timeline; both zoom and move together. "
        "<code>cfepy plot</code> draws them into a file, and <code>cfepy export csv</code> writes every value."
    )
    inside = element("p", search, class_="filter") + element("div", picker + drawn, class_="values")
    return section("Values over time", "values", inside, " ".join([about, *_thinned(values, recorded)]))


def limits_section(recorded: SeriesSet) -> str:
    """Return the section about the measurements with limits; empty without any."""
    rows = [row for name in recorded.names for row in _limit_rows(recorded.series(name))]
    if not rows:
        return ""
    heads = ("Field", "Verdict", "Lowest", "Highest", "Unit", "Yellow", "Red", "First violation")
    inside = table("Measurements with limits", heads, rows, (2, 3), class_="log")
    about = "Engineering values of telemetry, with the limits that its application declares."
    return section("Limits", "limits", inside, about)


def _limit_rows(series: Series) -> Iterator[list[str]]:
    measured = {path: each for path, each in series.measured.items() if each.has_limits}
    if not measured or not len(series):
        return
    times = series.times.tolist()
    for path, each in measured.items():
        raws = [value_at(message, steps_of(path)) for message in series.messages]
        values = [each.value(raw) for raw in raws]
        violated = [each.violated(value) for value in values]
        worst = RED if RED in violated else YELLOW if YELLOW in violated else ""
        first = violated.index(worst) if worst else None
        mark = "missed" if worst == RED else "warned" if worst else "kept"
        at = "" if first is None else instant(round(times[first] * NS_PER_S), f"{times[first]:.6f} s")
        told = "" if first is None else f"{at}: {escaped(each.explained(values[first]))}"
        limits = [escaped(_range_text(each.limits(name))) for name in (YELLOW, RED)]
        verdict = element("span", escaped(worst or "kept"), class_=f"verdict {mark}")
        ends = [f"{min(values):.7g}", f"{max(values):.7g}"]
        yield [escaped(f"{series.name}.{path}"), verdict, *ends, escaped(each.unit), *limits, told]


def _range_text(limits: tuple[float | None, float | None]) -> str:
    low, high = ("" if each is None else f"{each:g}" for each in limits)
    return f"{low} to {high}" if low and high else f"from {low}" if low else f"to {high}" if high else ""


def _thinned(values: ValueData, recorded: SeriesSet) -> Iterator[str]:
    """Say which values were left off the page, and why."""
    if any(len(recorded.series(each["name"])) > len(each["times"]) for each in values.plain):
        yield "If there are many messages, the lowest and highest values of each time interval are drawn."
    if any(each["every"] > 1 for each in values.plain):
        yield "Of topics with very many messages, only every second, fourth, ... message is included."
    if values.shown < values.found:
        yield f"{values.shown:,} of {values.found:,} fields are included: the fields of the smaller messages."
