"""Pages of telemetry: the newest packet of each kind, field by field; changed values are marked.

A page is a selection of packets. It is laid out in columns for a given width. Its rows consist of styled texts, so that
a screen can colour them and a plain stream can omit the styles.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, field
from fnmatch import fnmatchcase
from typing import NamedTuple

from cfepy.ground import Decoded, Dictionary
from cfepy.mission import Seen
from cfepy.msg import RED, YELLOW
from cfepy.units import NS_PER_S
from cfepy.writing.escapes import visible_line

HK, ALL = "hk", "all"
TITLE, NAME, VALUE, CHANGED = "title", "name", "value", "changed"
GAP = 2
LEAST_COLUMN, MOST_COLUMN = 24, 38
ACCEPTED, REFUSED = "CommandCounter", "CommandErrorCounter"
DOTS = "…"


class Piece(NamedTuple):
    """A text and its style."""

    text: str
    style: str = VALUE


Row = list[Piece]


@dataclass(slots=True)
class Kind:
    """The packets of one MsgId: their number, the newest one, and its texts and violated limits at the last look."""

    newest: Seen
    count: int = 0
    looked: int = 0
    name: str = ""
    texts: dict[str, str] = field(default_factory=dict)
    changed: set[str] = field(default_factory=set)
    violations: dict[str, str] = field(default_factory=dict)


class PacketBoard:
    """Keeps the newest telemetry.

    Args:
        dictionary: names the packets and their fields.

    Attributes:
        page: the chosen page: "hk", "all", or names of packets.
        raw: whether measurements are shown as their raw numbers.
    """

    def __init__(self, dictionary: Dictionary) -> None:
        self.page: tuple[str, ...] = (HK,)
        self.raw = False
        self._dictionary = dictionary
        self._kinds: dict[int, Kind] = {}

    def note(self, seen: Seen) -> None:
        """Keep a telemetry packet that was sent."""
        msg_id = seen.packet[0] << 8 | seen.packet[1]
        kind = self._kinds.get(msg_id)
        if kind is None:
            kind = self._kinds[msg_id] = Kind(seen)
        kind.newest = seen
        kind.count += 1

    def choose(self, names: list[str]) -> None:
        """Turn to another page.

        Args:
            names: "hk", "all", or packets by name, MsgId or pattern. An empty list switches between hk and all.

        Raises:
            UsageError: there is no such packet.
        """
        if not names:
            names = [ALL if self.page == (HK,) else HK]
        for name in names:
            if name not in (HK, ALL) and not self._is_known(name):
                self._dictionary.telemetry_of(name)
        self.page = tuple(names)

    def show_raw(self, raw: bool) -> None:
        """Show measurements as raw numbers, or as engineering values."""
        self.raw = raw
        for kind in self._kinds.values():
            kind.looked = 0
            kind.texts.clear()

    def counters(self) -> tuple[int, int]:
        """Return how many commands the applications accepted and refused, according to their newest housekeeping."""
        accepted = refused = 0
        for kind in self._kinds.values():
            if not kind.name or _is_hk(kind.name):
                self._look(kind)
                accepted += int(kind.texts.get(ACCEPTED, 0))
                refused += int(kind.texts.get(REFUSED, 0))
        return accepted, refused

    def rows(self, width: int) -> list[Row]:
        """Lay out the chosen page.

        Args:
            width: columns of the screen.

        Returns:
            The rows.
        """
        if self.page == (ALL,):
            return list(self._overview(width))
        rows: list[Row] = []
        for kind in sorted(self._kinds.values(), key=lambda each: each.newest.msg_id):
            self._look(kind)
            if self._is_chosen(kind):
                rows += _rows_of(kind, width)
        return rows or [[Piece(f"no packet of {' '.join(self.page)} yet", NAME)]]

    def _is_known(self, name: str) -> bool:
        names = [*self._dictionary.telemetry, *(kind.name for kind in self._kinds.values())]
        return any(fnmatchcase(each, name) for each in names)

    def _is_chosen(self, kind: Kind) -> bool:
        if HK in self.page and _is_hk(kind.name):
            return True
        number = f"0x{kind.newest.msg_id:04X}"
        return any(fnmatchcase(kind.name, name) or name.lower() == number.lower() for name in self.page)

    def _look(self, kind: Kind) -> None:
        """Decode the newest packet, if it arrived after the last look."""
        if kind.looked == kind.count:
            return
        decoded = self._dictionary.decode(kind.newest.packet)
        texts = {path: visible_line(text) for path, text in _texts(decoded, kind.newest.packet, self.raw).items()}
        kind.changed = {path for path, text in texts.items() if kind.texts.get(path, text) != text}
        kind.name, kind.texts, kind.looked = visible_line(decoded.name), texts, kind.count
        kind.violations = decoded.violations

    def _overview(self, width: int) -> Iterator[Row]:
        """Yield a row for each kind of packet."""
        for kind in sorted(self._kinds.values(), key=lambda each: each.newest.msg_id):
            decoded = self._dictionary.decode(kind.newest.packet)
            head = f"{visible_line(decoded.name)}  {kind.count:,}  {kind.newest.at_ns / NS_PER_S:.3f}  "
            content = visible_line(decoded.problem or decoded.line(self.raw))
            yield [Piece(cut(head, width), TITLE), Piece(cut(content, max(0, width - len(head))))]


def _texts(decoded: Decoded, packet: bytes, raw: bool) -> dict[str, str]:
    if decoded.problem:
        return {"bytes": packet.hex(), "problem": decoded.problem}
    return decoded.texts(raw)


def _is_hk(name: str) -> bool:
    return name.endswith(("_HK_TLM", "_HK"))


def _rows_of(kind: Kind, width: int) -> Iterator[Row]:
    """Yield a packet's title, and its fields in as many columns as fit."""
    yield [Piece(cut(f"{kind.name}  n={kind.count:,}  at {kind.newest.at_ns / NS_PER_S:.3f}", width), TITLE)]
    lengths = {path: len(path) + 1 + len(text) for path, text in kind.texts.items()}
    most = min(MOST_COLUMN, width)
    short = [path for path, length in lengths.items() if length <= most]
    column = max([min(LEAST_COLUMN, width), *(lengths[path] for path in short)])
    across = max(1, (width + GAP) // (column + GAP))
    down = -(-len(short) // across)
    for line in range(down):
        yield [piece for path in short[line::down] for piece in _cell(path, kind, column)]
    for path, length in lengths.items():
        if length > most:
            yield _cell(path, kind, width)


def _cell(path: str, kind: Kind, width: int) -> Row:
    """Lay out `path value` with the value right-aligned. A text that is too long is cut."""
    name = cut(path, width)
    text = cut(kind.texts[path], width - len(name) - 1)
    blank = " " * (width - len(name) - len(text))
    style = CHANGED if path in kind.changed else VALUE
    violated = {name for each, name in kind.violations.items() if each == path or each.rpartition("[")[0] == path}
    style = next((name for name in (RED, YELLOW) if name in violated), style)
    return [Piece(name, NAME), Piece(blank), Piece(text, style), Piece(" " * GAP)]


def cut(text: str, width: int) -> str:
    """Shorten a text to a width in characters; dots mark the cut."""
    return text if len(text) <= width else text[: max(0, width - 1)] + DOTS if width > 0 else ""
