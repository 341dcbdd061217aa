"""The pictures of docs/explanation/design.md: the floors of the house, and the way of a message through it.

They are drawn from the tree: the floors from `floors.py`, the purpose of a package from the first sentence of its
docstring, the numbers from its imports. The stations of the message name functions, which must exist. The same tree
gives the same bytes. Colours follow the reader's preference, light or dark.
"""

from __future__ import annotations

import textwrap
from collections.abc import Iterable
from html import escape
from pathlib import Path
from typing import NamedTuple

from dev.house.floors import FLOORS, LEVEL
from dev.house.tree import Tree

HOUSE = Path("docs/pictures/house.svg")
MESSAGE = Path("docs/pictures/message.svg")

WIDTH = 960
MARGIN = 16
GAP = 8
NUMBERS = 92  # room at the right for the numbers of imports between floors
LINE = 14
LETTER = 6.0  # average width of a letter of small text

STYLE = """
text { font-family: system-ui, "Segoe UI", "DejaVu Sans", sans-serif; font-size: 11px; fill: #24292f }
.name { font: bold 13px ui-monospace, "DejaVu Sans Mono", monospace }
.where { font: 10.5px ui-monospace, "DejaVu Sans Mono", monospace; fill: #57606a }
.count { fill: #57606a; text-anchor: middle }
.ground { fill: #ffffff }
.room { fill: #ddf4ff; stroke: #0969da }
.base { fill: #f6f8fa; stroke: #8c959f }
.service { fill: #fff8c5; stroke: #bf8700 }
.node { fill: #dafbe1; stroke: #1a7f37 }
.arrow { stroke: #57606a; stroke-width: 1.5; fill: none }
.head { fill: #57606a }
@media (prefers-color-scheme: dark) {
  text { fill: #e6edf3 }
  .where, .count { fill: #9da7b3 }
  .ground { fill: #0d1117 }
  .room { fill: #0c2d6b; stroke: #4493f8 }
  .base { fill: #21262d; stroke: #656d76 }
  .service { fill: #3d2e00; stroke: #d4a72c }
  .node { fill: #0f3d1f; stroke: #3fb950 }
  .arrow { stroke: #9da7b3 }
  .head { fill: #9da7b3 }
}
"""
KINDS = dict.fromkeys(("es", "sb", "evs", "time", "tbl"), "service")
KINDS |= dict.fromkeys(("nodes", "rospy_shim"), "node")
KINDS |= dict.fromkeys(FLOORS[0], "base")


class Station(NamedTuple):
    """A step of a message's way: the event, the function and module that perform it, and the kind of package."""

    text: str
    module: str
    function: str
    kind: str


WAY = (
    Station("A node publishes a message of rospy.", "rospy_shim.client.topics", "Publisher.publish", "node"),
    Station(
        "It is serialised once, by code made for its type, behind room for the packet's header; a long one is cut into"
        " segments.",
        "rospy_shim.client.link",
        "Link.send",
        "node",
    ),
    Station(
        "The Software Bus fills in sequence count and time, puts the packet into the trace, and finds the route of its"
        " MsgId: for each pipe a limit, then one append, or the hand-over to a receiver that waits.",
        "cfepy.sb.bus",
        "SoftwareBus.transmit_msg",
        "service",
    ),
    Station(
        "The kernel gives the processor to the receiver, if that is more urgent than the sender.",
        "cfepy.rtos.scheduler",
        "Scheduler.make_ready",
        "room",
    ),
    Station(
        "The receiver's call returns the packet, the same bytes for all of them. An application goes on with it here.",
        "cfepy.sb.bus",
        "SoftwareBus.receive_buffer",
        "service",
    ),
    Station(
        "In a node, a task of the subscription puts segments together, deserialises and calls the callbacks.",
        "rospy_shim.client.subscription",
        "Subscription.deliver",
        "node",
    ),
)


def house(tree: Tree) -> str:
    """Return the floors with their rooms, and how many imports go down through each ceiling."""
    rows: list[str] = []
    y = MARGIN
    crossing = _crossings(tree)
    for level in range(len(FLOORS) - 1, 0, -1):
        parts = [part for part in FLOORS[level] if part not in ("__main__", "__init__", "extra")]
        if not parts:
            continue
        height = _row(rows, tree, parts, y)
        y += height
        middle = WIDTH - MARGIN - NUMBERS / 2
        rows.append(_arrow(middle, y - height / 2, y + GAP / 2, f"{crossing[level - 1]:,}"))
        y += GAP
    base = textwrap.wrap(" ".join(FLOORS[0]), _letters(WIDTH - 2 * MARGIN - NUMBERS - GAP) - 14)
    height = LINE * len(base) + 16
    rows.append(_box(MARGIN, y, WIDTH - 2 * MARGIN - NUMBERS - GAP, height, "base"))
    rows += [_text(MARGIN + 8, y + 18 + LINE * index, line, "name") for index, line in enumerate(base)]
    y += height + MARGIN + 4
    note = "A package imports only from floors below its own. Numbers: pairs of modules that meet across the line."
    rows.append(_text(MARGIN, y, note, "where"))
    return _svg("The floors of the house", y + MARGIN, rows)


def message(tree: Tree) -> str:
    """Return the way of a message from a node's publisher to a subscriber's callback."""
    rows: list[str] = []
    y = MARGIN
    for index, station in enumerate(WAY):
        name = f"{station.module}:{station.function}"
        assert any(station.function == each.name for each in tree.modules[station.module].functions()), name
        lines = textwrap.wrap(f"{index + 1}. {station.text}", _letters(WIDTH - 2 * MARGIN - 16))
        height = LINE * (len(lines) + 1) + 16
        rows.append(_box(MARGIN, y, WIDTH - 2 * MARGIN, height, station.kind))
        rows += [_text(MARGIN + 8, y + 18 + LINE * at, line) for at, line in enumerate(lines)]
        rows.append(_text(MARGIN + 8, y + 18 + LINE * len(lines), name, "where"))
        y += height
        if index + 1 < len(WAY):
            rows.append(_arrow(WIDTH / 2, y, y + 18))
            y += 20
    return _svg("The way of a message", y + MARGIN, rows)


def draw(tree: Tree) -> dict[Path, str]:
    """Return all pictures, by their path from the root of the tree."""
    return {HOUSE: house(tree), MESSAGE: message(tree)}


def _crossings(tree: Tree) -> list[int]:
    """For each floor how many imports come through its ceiling: from above it to it or below."""
    counts = [0] * len(FLOORS)
    for module in tree.modules.values():
        for name in tree.arrows(module):
            for level in range(LEVEL[tree.modules[name].part], LEVEL[module.part]):
                counts[level] += 1
    return counts


def _row(rows: list[str], tree: Tree, parts: list[str], y: float) -> int:
    """Draw the packages of a floor side by side. Returns the height of the row."""
    width = (WIDTH - 2 * MARGIN - NUMBERS - GAP * len(parts)) / len(parts)
    texts = [textwrap.wrap(_purpose(tree, part), _letters(width - 16)) for part in parts]
    height = LINE * (1 + max(map(len, texts))) + 16
    for index, (part, lines) in enumerate(zip(parts, texts, strict=True)):
        x = MARGIN + index * (width + GAP)
        rows.append(_box(x, y, width, height, KINDS.get(part, "room")))
        rows.append(_text(x + 8, y + 18, part, "name"))
        rows += [_text(x + 8, y + 32 + LINE * at, line) for at, line in enumerate(lines)]
    return height


def _purpose(tree: Tree, part: str) -> str:
    if part == "apps":
        return "The applications that cfepy brings along."
    text = next(tree.modules[each.room].purpose for each in tree.modules.values() if each.part == part)
    return text.removeprefix("rospy_shim: ").replace("`", "")


def _letters(width: float) -> int:
    return int(width / LETTER)


def _number(value: float) -> str:
    return f"{value:.1f}".removesuffix(".0")


def _box(x: float, y: float, width: float, height: float, kind: str) -> str:
    place = f'x="{_number(x)}" y="{_number(y)}" width="{_number(width)}" height="{_number(height)}"'
    return f'<rect {place} rx="4" class="{kind}"/>'


def _text(x: float, y: float, text: str, kind: str = "") -> str:
    style = f' class="{kind}"' if kind else ""
    return f'<text x="{_number(x)}" y="{_number(y)}"{style}>{escape(text, quote=False)}</text>'


def _arrow(x: float, start: float, end: float, count: str = "") -> str:
    """Draw an arrow down, with a number beside it."""
    at = _number(x)
    shaft = f'<path class="arrow" d="M{at} {_number(start)}V{_number(end - 5)}"/>'
    tip = f'<path class="head" d="M{_number(x - 4)} {_number(end - 6)}h8l-4 6z"/>'
    return shaft + tip + (_text(x + 24, end - 6, count, "count") if count else "")


def _svg(title: str, height: float, rows: Iterable[str]) -> str:
    size = f'width="{WIDTH}" height="{_number(height)}" viewBox="0 0 {WIDTH} {_number(height)}"'
    head = f'<svg xmlns="http://www.w3.org/2000/svg" {size} role="img">\n<title>{title}</title>\n<style>{STYLE}</style>'
    ground = '<rect width="100%" height="100%" class="ground"/>'
    return "\n".join((head, ground, *rows, "</svg>")) + "\n"
