"""Differences between the sources of a mission's dictionary, for `cfepy check`.

Each packet of a source is compared with the same packet, by MsgId and function code, of the source that names it. Names
of fields may be spelt differently, but places and types must be the same. The debug data is compared with the header in
which its struct is declared, too: a header that is newer than the shared object differs.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import NamedTuple

from cfepy.es import StartupEntry
from cfepy.extra.dictionaries.c_header import header_difference
from cfepy.extra.dictionaries.mission_sources import DEBUG_DATA, contents_at
from cfepy.extra.dictionaries.packets import DeclaredPacket, SourceContent
from cfepy.mission import MissionSections
from cfepy.msg import Cell, Layout
from cfepy.pilot import MissionProblem

_INDEX = re.compile(r"\[\d+\]")
_GAP = re.compile(r"spare_\d+")
"""Padding that the debug data has no field for."""
_BYTES = ("u8", "i8", "bool", "char")
_REMEDY = "correct the one that is wrong, or build again"


class _Member(NamedTuple):
    """A field of a packet: path, type, first bit, number of bits, and number of items."""

    path: str
    type: str
    start: int
    bits: int
    items: int

    def __str__(self) -> str:
        """Return type and place, such as "u16[4] at offset 2"."""
        text = f"{self.type}[{self.items}]" if self.items > 1 else self.type
        bit = f", bit {self.start % 8}" if self.start % 8 else ""
        return f"{text} at offset {self.start // 8}{bit}"


def check_dictionary(script: Path, entries: list[StartupEntry], said: MissionSections) -> Iterator[MissionProblem]:
    """Yield the unreadable parts of the sources of a dictionary, and their differences.

    Args:
        script: the startup script.
        entries: its entries.
        said: the sections of the mission file.
    """
    contents = contents_at(said.dictionary, script.parent, entries)
    for content in contents:
        for problem in content.problems:
            yield MissionProblem(problem.file, problem.line, problem.text, is_warning=True)
    yield from _differences(contents)
    for content in contents:
        if content.kind == DEBUG_DATA:
            yield from _newer_headers(content)


def _differences(contents: Sequence[SourceContent]) -> Iterator[MissionProblem]:
    first: dict[tuple[int, int], tuple[SourceContent, DeclaredPacket]] = {}
    named: dict[str, tuple[SourceContent, DeclaredPacket]] = {}
    for content in contents:
        new: dict[tuple[int, int], tuple[SourceContent, DeclaredPacket]] = {}
        for packet in content.packets:
            key = packet.msg_id, packet.code or 0
            known = first.get(key)
            same = named.setdefault(_plain(packet.name), (content, packet))
            if same[0] is not content and key != (same[1].msg_id, same[1].code or 0):
                yield _moved(*same, content, packet)
            elif known is None:
                new.setdefault(key, (content, packet))
            elif known[0] is not content:
                yield from _compared(*known, content, packet)
        yield from _missing(first, content, new)
        first |= new


def _moved(
    source: SourceContent, packet: DeclaredPacket, other: SourceContent, there: DeclaredPacket
) -> MissionProblem:
    """Return the difference of packets with the same name, but another MsgId or function code."""
    if packet.msg_id != there.msg_id:
        what = f"the MsgId 0x{packet.msg_id:04X} in the {source.kind}, but 0x{there.msg_id:04X}"
    else:
        what = f"the code {packet.code} in the {source.kind}, but {there.code}"
    text = f"{packet.name}: has {what} in {_shown(other, there)}; {_REMEDY}"
    return MissionProblem(packet.file, packet.line, text, is_warning=True)


def _missing(
    first: dict[tuple[int, int], tuple[SourceContent, DeclaredPacket]],
    content: SourceContent,
    new: dict[tuple[int, int], tuple[SourceContent, DeclaredPacket]],
) -> Iterator[MissionProblem]:
    """Yield commands that an earlier source lacks although it declares others of the same MsgId."""
    for (msg_id, code), (_, packet) in new.items():
        others = [known for (other, _), known in first.items() if other == msg_id]
        if packet.is_command and packet.code is not None and others:
            source, sibling = others[0]
            text = f"{sibling.name}: the {source.kind} has no command with the code {code} of 0x{msg_id:04X}, unlike "
            text += f"{_shown(content, packet)} ({packet.name}); add it"
            yield MissionProblem(sibling.file, sibling.line, text, is_warning=True)


def _compared(
    source: SourceContent, packet: DeclaredPacket, other: SourceContent, there: DeclaredPacket
) -> Iterator[MissionProblem]:
    """Yield the first difference of a packet; later ones follow from it."""
    mine, theirs = members(packet.payload), members(there.payload)
    by_name = {_plain(each.path): each for each in theirs}
    by_start = {each.start: each for each in theirs}
    shown = _shown(other, there) + (
        f" (called {there.name} there)" if _plain(there.name) != _plain(packet.name) else ""
    )
    for each in mine:
        found = by_name.get(_plain(each.path)) or by_start.get(each.start)
        if found is None:
            at = next((other for other in theirs if other.start <= each.start < other.start + other.bits), None)
            what = "no field" if at is None else f"{at.path} ({at})"
            text = f"is {each} in the {source.kind}, but {shown} has {what} there"
        elif not _is_same(each, found):
            text = f"is {each} in the {source.kind}, but {found} in {shown}"
        else:
            continue
        line = packet.lines.get(_INDEX.sub("", each.path), packet.line)
        yield MissionProblem(packet.file, line, f"{packet.name}.{each.path}: {text}; {_REMEDY}", is_warning=True)
        return
    if packet.payload.size != there.payload.size:
        sizes = f"{packet.payload.size} bytes in the {source.kind}, but {there.payload.size} in {shown}"
        text = f"{packet.name}: its payload has {sizes}; {_REMEDY}"
        yield MissionProblem(packet.file, packet.line, text, is_warning=True)


def _shown(content: SourceContent, packet: DeclaredPacket) -> str:
    """Return the place of a packet in the text of a problem."""
    place = f"{packet.file}:{packet.line}" if packet.line else str(packet.file)
    if content.kind != DEBUG_DATA:
        return f"the {content.kind} ({place})"
    struct = packet.structs[-1] if packet.structs else packet.name
    library = "" if packet.library is None else f" of {packet.library.name}"
    return f"the {DEBUG_DATA}{library} ({struct}, {place})"


def members(layout: Layout) -> list[_Member]:
    """Return the fields of a layout in order, each array of numbers or texts as one."""
    found: list[_Member] = []
    for cell in layout.cells():
        last = found[-1] if found else None
        path = _array_path(cell)
        if last is not None and path != cell.path and last.path == path and last.type == cell.type:
            bits = cell.start + cell.width - last.start
            found[-1] = last._replace(bits=bits, items=last.items + 1)
        else:
            found.append(_Member(path, cell.type, cell.start, cell.width, 1))
    return found


def _array_path(cell: Cell) -> str:
    """Return the path of a cell without the indices at its end."""
    return re.sub(r"(\[\d+\])+$", "", cell.path)


def _plain(path: str) -> str:
    return re.sub(r"[\W_]", "", path).lower()


def _is_same(one: _Member, other: _Member) -> bool:
    if (one.start, one.bits) != (other.start, other.bits):
        return False
    types = [each.type.partition("[")[0] for each in (one, other)]
    return types[0] == types[1] or all(each in _BYTES for each in types)


def _newer_headers(content: SourceContent) -> Iterator[MissionProblem]:
    seen: set[tuple[Path, str]] = set()
    for packet in content.packets:
        struct = packet.structs[-1] if packet.structs else ""
        if not struct or not packet.line or (packet.file, struct) in seen or packet.library is None:
            continue
        seen.add((packet.file, struct))
        difference = header_difference(packet.file, struct, members_of_struct(packet.payload))
        if difference is not None:
            line, text = difference
            text = f"{struct}{text} in the {DEBUG_DATA} of {packet.library.name}; build it again"
            yield MissionProblem(packet.file, line, text, is_warning=True)


def members_of_struct(layout: Layout) -> list[tuple[str, str, int]]:
    """Return name, type and number of items of the fields of a struct; "" as type of a nested struct."""
    found: dict[str, tuple[str, int]] = {}
    for cell in layout.cells():
        name = re.split(r"[.\[]", cell.path, maxsplit=1)[0]
        kind = cell.type if _array_path(cell) == name else ""
        found[name] = (kind, found.get(name, ("", 0))[1] + 1)
    return [(name, kind, count) for name, (kind, count) in found.items() if not _GAP.fullmatch(name)]
