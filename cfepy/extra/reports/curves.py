"""Curves of values over time, and a picture of them with matplotlib, which is imported when one is drawn.

    curves = curves_of(recorder, "/joint_states.position")  # of a `SeriesSet`
    save(picture_of([curves], title="capture"), Path("capture.png"))

Drawing needs no display. The script of a page draws the same curves in a browser.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from cfepy.ground import Series, SeriesSet
from cfepy.msg import RED, YELLOW
from cfepy.status import UsageError

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure
    from numpy.typing import NDArray

MOST_POINTS = 6_000
"""Points of a line: more than twice as many as a picture has columns, so the reduction is not visible."""

MOST_CHANGES, FEW_CHANGES = 60, 8  # of a text
FEW_POINTS = 60
SIZE = (10.0, 4.5)  # inches
EXTRA_HEIGHT = 2.2  # inches for each further axes
DPI = 144
MOST_OF_COLORS, MOST_IN_CORNER, MOST_NAMED = 10, 4, 16
LIMIT_COLORS = {RED: "C3", YELLOW: "goldenrod"}
LIMIT_LINES: dict[str, Any] = {RED: (0, (6, 2)), YELLOW: (0, (2, 2))}
LIMIT_RIM = 0.03  # of the height, beyond a limit
HEADER = "header."  # fields of a whole message that are not drawn


class Curve(NamedTuple):
    """A line with its label, times in s, and values."""

    label: str
    times: NDArray[Any]
    values: NDArray[Any]


class Change(NamedTuple):
    """A change of a text: its time in s, and the new text."""

    time: float
    text: str


@dataclass(frozen=True, slots=True)
class Curves:
    """The curves of a name such as "/joint_states.position".

    Attributes:
        name: name of the topic or packet.
        field: path of the field; empty for a whole message.
        unit: unit of the values; empty if it is not known.
        lines: a line for each number in the field.
        changes: changes of the text in it, by time.
        limits: limits of the lines: `RED` or `YELLOW`, and the value.
    """

    name: str
    field: str
    unit: str
    lines: tuple[Curve, ...]
    changes: tuple[Change, ...] = ()
    limits: tuple[tuple[str, float], ...] = ()

    @property
    def title(self) -> str:
        """The name of the curves, with the unit."""
        name = f"{self.name}.{self.field}" if self.field else self.name
        return f"{name}, {self.unit}" if self.unit else name

    def since(self, from_s: float) -> Curves:
        """Return the part of the curves from a virtual time on."""
        lines = [(each, each.times >= from_s) for each in self.lines]
        cut = tuple(Curve(each.label, each.times[left], each.values[left]) for each, left in lines)
        return replace(self, lines=cut, changes=tuple(each for each in self.changes if each.time >= from_s))


def curves_of(series: SeriesSet, word: str, raw: bool = False) -> list[Curves]:
    """Return the curves of a field; for a pattern, the curves of each matching topic.

    Args:
        series: the values of a run.
        word: a topic or packet, with or without a field.
        raw: whether measurements are drawn as their raw numbers, without unit and limits.

    Raises:
        UsageError: no matching message was sent, there is no such field, or it cannot be drawn.
    """
    return [_curves(found, field, raw) for found, field in series.matching(word)]


def _curves(series: Series, field: str, raw: bool) -> Curves:
    columns = {path: column for path, column in series.columns(field).items() if field or not path.startswith(HEADER)}
    times = series.times
    lines = [
        Curve(_label(series, path), times, (column if raw else series.engineering(path, column)).astype(float))
        for path, column in columns.items()
        if column.dtype.kind in "iufb"
    ]
    texts = [column for column in columns.values() if column.dtype.kind == "O"] if not lines else []
    changes = _changes(times, texts[0]) if len(texts) == 1 else []
    if not lines and not 0 < len(changes) <= MOST_CHANGES:
        what = (
            f"changes {len(changes)} times, {MOST_CHANGES} can be marked" if changes else "neither numbers nor a text"
        )
        raise UsageError(f"cannot be drawn: {what}", file=series.name, field=field or None)
    limits = () if raw else limits_of(series, field, [path for path in columns if path in series.measured])
    unit = "" if raw and series.measured else series.unit(field)
    return Curves(series.name, field, unit, tuple(lines), tuple(changes), limits)


def limits_of(series: Series, field: str, paths: Sequence[str]) -> tuple[tuple[str, float], ...]:
    """Return the limits of a field, each once; none for a whole packet, whose fields have limits of their own."""
    found = {
        (name, limit): None
        for path in paths
        if field
        for name in (YELLOW, RED)
        for limit in series.measured[path].limits(name)
        if limit is not None
    }
    return tuple(found)


def _label(series: Series, path: str) -> str:
    """Return the label of a line. An item of an array gets its name from the message, as in sensor_msgs/JointState."""
    names = getattr(series.messages[0], "name", None)
    array, bracket, rest = path.partition("[")
    number = rest.rstrip("]")
    if bracket and isinstance(names, list | tuple) and number.isdecimal() and int(number) < len(names):
        return f"{array}[{number}] {names[int(number)]}"
    return path


def _changes(times: NDArray[Any], column: NDArray[Any]) -> list[Change]:
    found: list[Change] = []
    before = None
    for time, text in zip(times.tolist(), column.tolist(), strict=True):
        if isinstance(text, str) and text != before:
            found.append(Change(time, text))
            before = text
    return found


def thinned(curve: Curve, most: int) -> Curve:
    """Reduce a curve to a number of points. Each interval keeps its lowest and its highest point, so no peak is lost.

    Args:
        curve: a curve with its times in order.
        most: maximum number of points, 4 or more.

    Returns:
        The reduced curve.
    """
    import numpy

    count = len(curve.times)
    if count <= most:
        return curve
    edges = numpy.linspace(0, count, most // 2 + 1).astype(int)
    kept: set[int] = {0, count - 1}
    for start, stop in zip(edges[:-1].tolist(), edges[1:].tolist(), strict=True):
        piece = curve.values[start:stop]
        if numpy.isnan(piece).all():
            kept.add(start)
        else:
            kept |= {start + int(numpy.nanargmin(piece)), start + int(numpy.nanargmax(piece))}
    chosen = numpy.array(sorted(kept))
    return Curve(curve.label, curve.times[chosen], curve.values[chosen])


# -- the picture -------------------------------------------------------------------------------------------------------


def picture_of(axes: Sequence[Sequence[Curves]], *, title: str = "", size: tuple[float, float] | None = None) -> Figure:
    """Draw a `matplotlib.figure.Figure`, one axes below the other, all over the same times.

    Args:
        axes: the curves of each axes. Changes of texts are marked in all of them.
        title: title above it.
        size: width and height in inches; None chooses a suitable size.

    Returns:
        The figure.

    Raises:
        UsageError: matplotlib is not installed.
    """
    figure_of_matplotlib()
    drawn = [curves for curves in axes if any(each.lines for each in curves)] or list(axes)[:1]
    changes = [change for curves in axes for each in curves for change in each.changes]
    height = SIZE[1] + EXTRA_HEIGHT * (len(drawn) - 1)
    figure = figure_of_matplotlib(figsize=size or (SIZE[0], height), dpi=DPI, layout="constrained")
    places = figure.subplots(len(drawn), 1, sharex=True, squeeze=False)[:, 0]
    for number, (place, curves) in enumerate(zip(places, drawn, strict=True)):
        _draw(place, curves)
        _draw_changes(place, changes, with_texts=number == 0)
    places[-1].set_xlabel("virtual time, s")
    if title:
        figure.suptitle(title, x=0.01, horizontalalignment="left", fontweight="bold")
    return figure


def picture_of_words(series: SeriesSet, words: Sequence[str], title: str, file: Path | None) -> Figure:
    """Draw the values of names, as `cfepy plot` does.

    Args:
        series: the values of a run.
        words: names such as "/joint_states.position".
        title: title above the picture.
        file: an output file, or None.

    Returns:
        The figure.

    Raises:
        UsageError: there is no such message or field, or matplotlib is not installed.
        OSError, ValueError: the file cannot be written.
    """
    figure = picture_of([curves_of(series, word) for word in words], title=title)
    if file is not None:
        save(figure, file)
    return figure


def figure_of_matplotlib(**settings: Any) -> Figure:
    """Make an empty picture; matplotlib is imported for it.

    Args:
        settings: arguments of `matplotlib.figure.Figure`.

    Returns:
        The figure.

    Raises:
        UsageError: matplotlib is not installed.
    """
    try:
        from matplotlib.figure import Figure
    except ImportError:
        raise UsageError("pictures require the library matplotlib: pip install 'cfepy[plot]'") from None
    return Figure(**settings)


def save(picture: Figure, file: Path) -> None:
    """Write a picture as PNG, SVG or PDF, depending on the file name. The same picture gives the same bytes.

    Raises:
        OSError: it cannot be written.
    """
    from matplotlib import rc_context

    dates = {".svg": "Date", ".pdf": "CreationDate"}
    kind = file.suffix.lower()
    with rc_context({"svg.hashsalt": "cfepy"}):
        picture.savefig(file, metadata={dates[kind]: None} if kind in dates else None)


def _draw(place: Axes, curves: Sequence[Curves]) -> None:
    """Draw the lines of one axes."""
    shown = [each for each in curves if each.lines]
    lines = [(each, line) for each in shown for line in each.lines]
    colors = _colors(len(lines))
    for (each, line), color in zip(lines, colors, strict=True):
        few = thinned(line, MOST_POINTS)
        marker = "o" if len(few.times) < FEW_POINTS else None
        name = line.label if len(shown) == 1 else f"{each.name}.{line.label}"
        place.plot(few.times, few.values, color=color, linewidth=1.3, marker=marker, markersize=3, label=name)
    _draw_limits(place, dict.fromkeys(limit for each in shown for limit in each.limits))
    _dress(place, shown, len(lines))


def _draw_limits(place: Axes, limits: Iterable[tuple[str, float]]) -> None:
    """Draw lines with the names of limits; the axes grow for a limit near the curves, not for a distant one."""
    low, high = place.get_ylim()
    near = [value for _, value in limits if 2 * low - high <= value <= 2 * high - low]
    for name, value in limits:
        look: dict[str, Any] = {"color": LIMIT_COLORS[name], "linewidth": 1.0, "linestyle": LIMIT_LINES[name]}
        place.axhline(value, **look)
        if value in near:
            place.annotate(name, (1.0, value), xycoords=("axes fraction", "data"), fontsize="x-small", color="0.3")
    rim = (high - low) * LIMIT_RIM
    place.set_ylim(min([low, *(value - rim for value in near)]), max([high, *(value + rim for value in near)]))


def _colors(count: int) -> Any:
    from matplotlib import colormaps

    if count <= MOST_OF_COLORS:
        return colormaps["tab10"](list(range(count)))
    return colormaps["turbo"]([0.05 + 0.9 * number / (count - 1) for number in range(count)])


def _dress(place: Axes, shown: Sequence[Curves], count: int) -> None:
    """Set up axes, grid and legend."""
    for side in ("top", "right"):
        place.spines[side].set_visible(False)
    place.grid(True, color="0.9", linewidth=0.8)
    place.set_axisbelow(True)
    place.margins(x=0.01)
    place.ticklabel_format(axis="y", useOffset=False)
    units = {each.unit for each in shown}
    place.set_ylabel(shown[0].title if len(shown) == 1 else units.pop() if len(units) == 1 else "")
    look: dict[str, Any] = {"frameon": False, "fontsize": "small", "handlelength": 1.4}
    if count > MOST_NAMED:
        look |= {"handles": place.lines[:MOST_NAMED], "title": f"{count} lines, the first are"}
    if count > MOST_IN_CORNER:
        place.legend(loc="upper left", bbox_to_anchor=(1.0, 1.0), **look)
    elif count > 1:
        place.legend(loc="best", **look)


def _draw_changes(place: Axes, changes: Sequence[Change], with_texts: bool) -> None:
    for change in changes:
        place.axvline(change.time, color="0.45", linewidth=0.9, linestyle=(0, (4, 3)))
        if with_texts:
            place.annotate(
                change.text,
                (change.time, 1.0),
                xycoords=("data", "axes fraction"),
                xytext=(-2, 4),
                textcoords="offset points",
                fontsize="small",
                color="0.3",
                rotation=0 if len(changes) <= FEW_CHANGES else 45,
                annotation_clip=False,
            )
