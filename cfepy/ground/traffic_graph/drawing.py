"""The graph of a mission as a drawing (SVG): senders, messages, receivers, from left to right.

A unit that sends and receives is on both sides, so that no line goes back. Messages with the same senders and receivers
share a box. Boxes are ordered so that few lines cross (the barycentre method), then placed beside connected boxes. No
other program is needed, and the same graph gives the same bytes.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from html import escape

from cfepy.ground.traffic_graph.graph_texts import about_text, kind_text, room_text
from cfepy.ground.traffic_graph.model import CORE_NAME, Channel, MissionGraph, Offer, Taker

MARGIN, GAP, LINE, PAD = 16, 14, 17, 8
LEFT, MIDDLE, RIGHT, BETWEEN = 170, 290, 280, 130  # widths of the columns, and of the space for lines
LETTER = 6.5  # average width of a letter
SWEEPS = 24
TOP = 58
LEGEND = "dashed frame: no sender or no receiver"
HUES = ("#0969da", "#1a7f37", "#bc4c00", "#8250df", "#bf3989", "#9a6700", "#0e7c86", "#cf222e")
GREY = "#6e7781"
_CONTROLS = re.compile(r"[\x00-\x1f\x7f\ud800-\udfff\ufffe\uffff]")
STYLE = """
.graph text { font: 12px system-ui, "Segoe UI", "DejaVu Sans", sans-serif; fill: #24292f }
.graph .name { font-weight: 600 }
.graph .title { font-size: 16px; font-weight: 600 }
.graph .small { font-size: 10.5px; fill: #57606a }
.graph .right { text-anchor: end }
.graph .amid { text-anchor: middle }
.graph .ground { fill: #ffffff }
.graph .box { fill: #f6f8fa; stroke: #d0d7de }
.graph .loose { stroke-dasharray: 4 3 }
.graph .line { fill: none; stroke-width: 1.4; stroke-opacity: 0.75 }
.graph .line:hover { stroke-width: 3; stroke-opacity: 1 }
@media (prefers-color-scheme: dark) {
  .graph text { fill: #e6edf3 }
  .graph .small { fill: #9198a1 }
  .graph .ground { fill: #0d1117 }
  .graph .box { fill: #161b22; stroke: #3d444d }
  .graph path { filter: brightness(1.5) }
}
"""


@dataclass(slots=True)
class Box:
    """A box of the drawing, and its neighbours in the columns beside it, each with the height of its port.

    Attributes:
        key: the represented object.
        height: in px, like all places and sizes.
        y: its upper edge.
    """

    key: str
    height: float
    links: list[Box] = field(default_factory=list)
    y: float = 0.0

    @property
    def middle(self) -> float:
        """The height of its middle."""
        return self.y + self.height / 2


class Drawing:
    """A drawing under construction.

    Args:
        graph: the graph.
        is_document: whether it is a document of its own, and not part of a page.
    """

    def __init__(self, graph: MissionGraph, is_document: bool) -> None:
        self._graph = graph
        self._space = ' xmlns="http://www.w3.org/2000/svg"' if is_document else ""
        self._groups = _groups(graph.channels)
        self._units = {unit.name: unit for unit in graph.units}
        self._hues = {unit.name: HUES[at % len(HUES)] for at, unit in enumerate(graph.units)}
        self._pipes = _pipes_of(graph)
        self._offers: dict[str, list[Offer]] = {}
        for offer in graph.offers:
            self._offers.setdefault(offer.unit, []).append(offer)
        self._parts: list[str] = []

    def text(self) -> str:
        """Return the drawing."""
        left, middle, right = self._columns()
        bottom = _settle(left, middle, right)
        self._lines(left, middle, right)
        for box in left.values():
            self._unit(box, MARGIN, LEFT)
        for key, box in middle.items():
            self._messages(box, self._groups[key])
        for box in right.values():
            self._unit(box, _X_RIGHT, RIGHT)
            self._inside(box)
        return self._document(bottom + MARGIN)

    # -- columns -------------------------------------------------------------------------------------------------------

    def _columns(self) -> tuple[dict[str, Box], dict[str, Box], dict[str, Box]]:
        left: dict[str, Box] = {}
        middle: dict[str, Box] = {}
        right: dict[str, Box] = {}
        for key, channels in self._groups.items():
            box = middle[key] = Box(key, 2 * PAD + LINE * sum(map(_rows, channels)))
            for sender in channels[0].senders:
                _link(left.setdefault(sender, Box(sender, 2 * PAD + 2 * LINE)), box)
            for taker in dict.fromkeys(each.unit for each in channels[0].subscriptions):
                _link(right.setdefault(taker, self._taker(taker)), box)
        for unit in self._offers:
            right.setdefault(unit, self._taker(unit))
        return left, middle, right

    def _taker(self, name: str) -> Box:
        rows = len(self._pipes.get(name, ())) + len(self._offers.get(name, ()))
        return Box(name, 2 * PAD + LINE * (2 + rows))

    # -- drawing -------------------------------------------------------------------------------------------------------

    def _lines(self, left: dict[str, Box], middle: dict[str, Box], right: dict[str, Box]) -> None:
        for name, box in left.items():
            targets = sorted(box.links, key=lambda each: each.middle)
            for at, target in enumerate(targets):
                arrival = _port(target, sorted(_sources(target, left), key=lambda each: each.middle), box)
                self._line(MARGIN + LEFT, _spread(box, at, len(targets)), _X_MIDDLE, arrival, self._hues[name])
        for key, box in middle.items():
            channels = self._groups[key]
            hue = self._hues[channels[0].senders[0]] if channels[0].senders else GREY
            takers = channels[0].subscriptions
            ends = sorted({self._pipe_y(right[each.unit], each.pipe) for each in takers})
            for at, end in enumerate(ends):
                self._line(_X_MIDDLE + MIDDLE, _spread(box, at, len(ends)), _X_RIGHT, end, hue)

    def _line(self, x: float, y: float, to_x: float, to_y: float, hue: str) -> None:
        bend, tip = (to_x - x) / 2, to_x - 6
        path = f"M{x:g} {y:.1f}C{x + bend:g} {y:.1f} {to_x - bend:g} {to_y:.1f} {tip:g} {to_y:.1f}"
        self._parts.append(f'<path class="line" stroke="{hue}" d="{path}"/>')
        point = f"M{tip:g} {to_y - 3.5:.1f}L{to_x:g} {to_y:.1f}L{tip:g} {to_y + 3.5:.1f}Z"
        self._parts.append(f'<path fill="{hue}" d="{point}"/>')

    def _pipe_y(self, box: Box, pipe: str) -> float:
        """Return where lines into a pipe end; the pipes of cFE's services as one box are not distinguished."""
        if box.key == CORE_NAME:
            return box.middle
        at = list(self._pipes[box.key]).index(pipe)
        return box.y + PAD + LINE * (2.5 + at) - 1

    def _unit(self, box: Box, x: float, width: float) -> None:
        unit = self._units[box.key]
        self._rect(x, box, width)
        stripe = f'x="{x:g}" y="{box.y:.1f}" width="5" height="{box.height:g}"'
        self._parts.append(f'<rect {stripe} rx="2" fill="{self._hues[box.key]}"/>')
        self._text(x + 14, box.y + PAD + 12, unit.name, "name", width - 20)
        self._text(x + 14, box.y + PAD + 12 + LINE, kind_text(unit), "small", width - 20)

    def _inside(self, box: Box) -> None:
        """Draw the pipes of a receiver, and its services."""
        y = box.y + PAD + 12 + 2 * LINE
        for pipe, takers in self._pipes.get(box.key, {}).items():
            room = room_text(takers)
            self._text(_X_RIGHT + 14, y, pipe, "", RIGHT - 24 - len(room) * LETTER * 0.85)
            self._text(_X_RIGHT + RIGHT - PAD, y, room, "small right", RIGHT)
            y += LINE
        for offer in self._offers.get(box.key, ()):
            self._text(_X_RIGHT + 14, y, f"{offer.kind} {offer.name}", "small", RIGHT - 20, offer.type)
            y += LINE

    def _messages(self, box: Box, channels: Sequence[Channel]) -> None:
        is_whole = channels[0].senders and channels[0].subscriptions
        self._rect(_X_MIDDLE, box, MIDDLE, "" if is_whole else " loose")
        y = box.y + PAD + 12
        for channel in channels:
            self._text(_X_MIDDLE + PAD, y, channel.name, "", MIDDLE - 70, f"{channel.name} {about_text(channel)}")
            self._text(_X_MIDDLE + MIDDLE - PAD, y, f"0x{channel.msg_id:04X}", "small right", MIDDLE)
            y += LINE
            if _rows(channel) > 1:
                self._text(_X_MIDDLE + PAD, y - 2, about_text(channel), "small", MIDDLE - 20)
                y += LINE

    def _rect(self, x: float, box: Box, width: float, more: str = "") -> None:
        place = f'x="{x:g}" y="{box.y:.1f}" width="{width:g}" height="{box.height:g}"'
        self._parts.append(f'<rect {place} rx="4" class="box{more}"/>')

    def _text(self, x: float, y: float, text: str, kind: str, width: float, about: str = "") -> None:
        """Draw a text, truncated if it is too long, with the full text as tooltip."""
        most = max(int(width / LETTER), 4)
        shown = text if len(text) <= most else text[: most - 1] + "\N{HORIZONTAL ELLIPSIS}"
        title = f"<title>{_escaped(about or text)}</title>" if about or shown != text else ""
        style = f' class="{kind}"' if kind else ""
        self._parts.append(f'<text x="{x:g}" y="{y:.1f}"{style}>{title}{_escaped(shown)}</text>')

    def _document(self, height: float) -> str:
        width = _X_RIGHT + RIGHT + MARGIN
        name, summary = _escaped(self._graph.mission), _escaped(self._graph.summary)
        head = f'<svg{self._space} class="graph" viewBox="0 0 {width} {height:.0f}" role="img" '
        head += f'width="{width}" height="{height:.0f}" aria-label="{name}: {summary}">'
        ground = '<rect width="100%" height="100%" class="ground"/>'
        title = f'<text x="{MARGIN}" y="28" class="title">{name}</text>'
        title += f'<text x="{MARGIN}" y="46" class="small">{summary}</text>'
        title += f'<text x="{_X_MIDDLE + MIDDLE / 2:g}" y="46" class="small amid">{LEGEND}</text>'
        return "\n".join([head, f"<style>{STYLE}</style>", ground, title, *self._parts, "</svg>"]) + "\n"


_X_MIDDLE = MARGIN + LEFT + BETWEEN
_X_RIGHT = _X_MIDDLE + MIDDLE + BETWEEN


def graph_svg(graph: MissionGraph, is_document: bool = True) -> str:
    """Return the graph drawn in SVG, in the colours of the reader's system.

    Args:
        graph: the graph.
        is_document: whether it is a document of its own, and not part of a page.
    """
    return Drawing(graph, is_document).text()


def _escaped(text: str) -> str:
    """Return a text escaped for XML."""
    return escape(_CONTROLS.sub("\N{REPLACEMENT CHARACTER}", text))


def _groups(channels: Iterable[Channel]) -> dict[str, list[Channel]]:
    """Messages with the same senders, takers and pipes together."""
    groups: dict[str, list[Channel]] = {}
    for channel in channels:
        pipes = sorted({(each.unit, "" if each.unit == CORE_NAME else each.pipe) for each in channel.subscriptions})
        groups.setdefault(repr((channel.senders, pipes, channel.is_topic)), []).append(channel)
    return groups


def _pipes_of(graph: MissionGraph) -> dict[str, dict[str, list[Taker]]]:
    """Return the pipes of each unit by name, with their subscriptions; cFE's services as one box have too many
    to show.
    """
    found: dict[str, dict[str, list[Taker]]] = {}
    for channel in graph.channels:
        for each in channel.subscriptions:
            if each.unit != CORE_NAME:
                found.setdefault(each.unit, {}).setdefault(each.pipe, []).append(each)
    return found


def _rows(channel: Channel) -> int:
    return 2 if channel.is_topic and about_text(channel) else 1


def _link(one: Box, other: Box) -> None:
    one.links.append(other)
    other.links.append(one)


def _sources(box: Box, column: dict[str, Box]) -> list[Box]:
    return [each for each in box.links if column.get(each.key) is each]


def _port(box: Box, neighbours: Sequence[Box], one: Box) -> float:
    at = next(index for index, each in enumerate(neighbours) if each is one)
    return _spread(box, at, len(neighbours))


def _spread(box: Box, at: int, count: int) -> float:
    """Return the height of one of several lines at a side of a box."""
    return box.y + box.height * (at + 1) / (count + 1)


# -- places ------------------------------------------------------------------------------------------------------------


def _settle(*columns: dict[str, Box]) -> float:
    """Place every box; returns the used height."""
    orders = [list(column.values()) for column in columns]
    best = _stack(orders)
    for sweep in range(SWEEPS):
        for order in orders if sweep % 2 else reversed(orders):
            order.sort(key=_wish)
            _stack([order])
        best = min(best, _stack(orders), key=lambda each: each[0])
    tallest = max(best[1], key=_height)
    _stack(best[1])
    for order in best[1]:
        if order is not tallest:
            _place(order, TOP + _height(tallest))
    return max((box.y + box.height for order in best[1] for box in order), default=TOP)


def _wish(box: Box) -> float:
    """Return the preferred place of a box: the mean of its neighbours."""
    return sum(each.middle for each in box.links) / len(box.links) if box.links else box.middle


def _height(order: Sequence[Box]) -> float:
    return sum(box.height + GAP for box in order)


def _stack(orders: Sequence[Sequence[Box]]) -> tuple[float, list[list[Box]]]:
    """Place the boxes of each column one below the other; returns the vertical extent of lines, and the orders."""
    for order in orders:
        y = float(TOP)
        for box in order:
            box.y, y = y, y + box.height + GAP
    length = sum(abs(box.middle - other.middle) for order in orders for box in order for other in box.links)
    return length, [list(order) for order in orders]


def _place(order: Sequence[Box], bottom: float) -> None:
    """Move each box towards its neighbours, as far as there is room."""
    y = float(TOP)
    for box in order:
        box.y = max(y, _wish(box) - box.height / 2)
        y = box.y + box.height + GAP
    limit = bottom - GAP
    for box in reversed(order):
        box.y = max(min(box.y, limit - box.height), float(TOP))
        limit = box.y - GAP
