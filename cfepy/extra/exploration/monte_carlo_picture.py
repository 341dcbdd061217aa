"""A sweep that draws values as a picture: the distribution of each measure, and the drawn values of failed runs."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

from cfepy.extra.exploration.monte_carlo import QUANTILES, Group, measured
from cfepy.extra.reports import DPI, figure_of_matplotlib

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

WIDTH, HEIGHT = 4.2, 2.8  # inches of one axes
ACROSS = 3
MOST_MEASURES, BARS = 9, 20
CLEAN, FAILED = "clean", "not clean"


def picture_of_draws(groups: Sequence[Group], title: str = "") -> Figure:
    """Return a `matplotlib.figure.Figure`: a cumulative distribution for each measure, and a row for the drawn values.

    Args:
        groups: the groups of runs, at least one.
        title: above it.

    Raises:
        UsageError: matplotlib is not installed.
    """
    measures = _varying(groups)
    shown = measures[:MOST_MEASURES]
    drawn = [name for name, _ in groups[0].rows[0].point.drawn if _numbers(groups, name)]
    count = max(1, len(shown) + len(drawn))
    across = min(ACROSS, count)
    down = -(-count // across)
    figure = figure_of_matplotlib(figsize=(WIDTH * across, HEIGHT * down + 0.5), dpi=DPI, layout="constrained")
    places = list(figure.subplots(down, across, squeeze=False).flat)
    for place, (measure, unit) in zip(places, shown, strict=False):
        _draw_measure(place, groups, measure, unit)
    for place, name in zip(places[len(shown) :], drawn, strict=False):
        _draw_values(place, groups, name)
    for place in places[count:]:
        place.set_visible(False)
    left_out = len(measures) - len(shown)
    note = f", without {left_out} further measures" if left_out else ""
    rate = "; ".join(group.text for group in groups) if len(groups) <= ACROSS else f"{len(groups)} groups"
    figure.suptitle(f"{title}: {rate}{note}", x=0.01, horizontalalignment="left", fontsize="medium", wrap=True)
    return figure


def _varying(groups: Sequence[Group]) -> list[tuple[str, str]]:
    """Return the measures, with their units, that are not the same number in all runs."""
    values: dict[tuple[str, str], set[float]] = {}
    for group in groups:
        for row in group.rows:
            for measure, unit, value in measured(row):
                values.setdefault((measure, unit), set()).add(value)
    return [each for each, different in values.items() if len(different) > 1]


def _draw_measure(place: Axes, groups: Sequence[Group], measure: str, unit: str) -> None:
    for number, group in enumerate(groups):
        values = [value for row in group.rows for name, _, value in measured(row) if name == measure]
        if values:
            place.ecdf(values, color=f"C{number % 10}", linewidth=1.3, label=group.name)
    for share in QUANTILES:
        place.axhline(share, color="0.8", linewidth=0.8, linestyle=(0, (1, 2)))
    place.set_yticks(QUANTILES, [f"{share:.0%}" for share in QUANTILES])
    place.set_xlabel(f"{measure}, {unit}" if unit else measure)
    place.set_ylabel("runs")
    if len(groups) > 1:
        place.legend(frameon=False, fontsize="x-small")
    _dress(place)


def _draw_values(place: Axes, groups: Sequence[Group], name: str) -> None:
    """Draw clean runs as bars over a drawn value, and the others above them, also with another hatch."""
    import numpy

    values = _numbers(groups, name)
    bins = numpy.histogram_bin_edges([value for value, _ in values], BARS)
    place.hist([value for value, _ in values], bins.tolist(), color="C3", hatch="//", edgecolor="white", label=FAILED)
    clean = [value for value, is_clean in values if is_clean]
    place.hist(clean, bins.tolist(), color="C0", edgecolor="white", label=CLEAN)
    place.set_xlabel(f"{name}, drawn")
    place.set_ylabel("runs")
    place.legend(frameon=False, fontsize="x-small")
    _dress(place)


def _numbers(groups: Sequence[Group], name: str) -> list[tuple[float, bool]]:
    """Return the drawn numbers of a parameter with whether the run was clean; empty if one is not a number."""
    found = []
    for group in groups:
        for row in group.rows:
            try:
                found.append((float(dict(row.point.drawn)[name]), not row.why_not_clean))
            except ValueError:
                return []
    return found


def _dress(place: Axes) -> None:
    place.grid(True, color="0.93", linewidth=0.8)
    place.set_axisbelow(True)
    for side in ("top", "right"):
        place.spines[side].set_visible(False)
