"""A sweep as a picture: the delivered rate over the requested rate, the latency of messages, and the CPU."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from cfepy.extra.reports import DPI, figure_of_matplotlib

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

SIZE = (8.0, 8.0)  # inches


@dataclass(slots=True)
class SweepLine:
    """A line of the picture: a board, or a varied value. Its points may come in any order.

    Attributes:
        name: in the legend.
        knee_hz: the highest clean rate; None if no rate or every rate is clean.
        points: requested and delivered rate (Hz), longest latency (ms), CPU (%).
    """

    name: str
    knee_hz: float | None
    points: list[tuple[float, float, float, float]] = field(default_factory=list)

    def add(self, rate_hz: float, came_hz: float, longest_ms: float, cpu_percent: float) -> None:
        """Add a point."""
        self.points.append((rate_hz, came_hz, longest_ms, cpu_percent))


def picture_of_sweep(lines: Sequence[SweepLine], title: str = "") -> Figure:
    """Return a `matplotlib.figure.Figure`: three axes over the requested rate.

    Args:
        lines: one for each board or value, with at least one point.
        title: above it.

    Raises:
        UsageError: matplotlib is not installed.
    """
    figure = figure_of_matplotlib(figsize=SIZE, dpi=DPI, layout="constrained")
    rates, latencies, shares = figure.subplots(3, 1, sharex=True, height_ratios=(2, 1, 1))
    asked = sorted({point[0] for line in lines for point in line.points})
    rates.plot(asked, asked, color="0.7", linewidth=1.0, linestyle=(0, (4, 3)), label="as asked for")
    for number, line in enumerate(lines):
        points = sorted(line.points)
        look: dict[str, Any] = {"color": f"C{number % 10}", "linewidth": 1.3, "marker": "o", "markersize": 3}
        for column, place in enumerate((rates, latencies, shares), 1):
            place.plot([each[0] for each in points], [each[column] for each in points], label=line.name, **look)
        if line.knee_hz is not None:
            rates.axvline(line.knee_hz, color=look["color"], linewidth=0.9, linestyle=(0, (1, 2)))
    rates.set_yscale("log")
    rates.legend(frameon=False, fontsize="small")
    for place, text in ((rates, "delivered, Hz"), (latencies, "longest latency, ms"), (shares, "CPU, %")):
        _dress(place, text)
    shares.set_xlabel("requested rate, Hz")
    if title:
        figure.suptitle(title, x=0.01, horizontalalignment="left", fontweight="bold")
    return figure


def _dress(place: Axes, text: str) -> None:
    place.set_xscale("log")
    place.set_ylabel(text)
    place.grid(True, color="0.9", linewidth=0.8)
    place.set_axisbelow(True)
    for side in ("top", "right"):
        place.spines[side].set_visible(False)
