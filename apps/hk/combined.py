"""The content of combined packets as a declaration for tools. It follows from the copy table."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from typing import Any, NamedTuple

from cfepy.msg import TLM_HEADER_SIZE, Layout, Telemetry

from .copy_table import CopyEntry, read_entries
from .packets import COMBINED_PKT1_MID

COMBINED_PKT1 = "HK_COMBINED_PKT1"


class _Piece(NamedTuple):
    """A field of a combined packet: its offset in the payload, its size in bytes, its type, and its name."""

    at: int
    size: int
    kind: Any
    name: str


def combined_telemetry(table: bytes | memoryview, known: Mapping[int, Telemetry]) -> list[Telemetry]:
    """Return the combined packets of a copy table. Fields have the names of the packets and fields that they copy.

    Parts of a packet that are not a whole field, or whose packet has no declared layout, are bytes.

    Args:
        table: the image of the table.
        known: declared telemetry by MsgId; a packet without a known layout has no payload.
    """
    found: dict[int, list[CopyEntry]] = {}
    for entry in read_entries(table):
        if entry.is_used and entry.fault() is None:
            found.setdefault(entry.output_mid, []).append(entry)
    return [_packet(msg_id, entries, known) for msg_id, entries in found.items()]


def _packet(msg_id: int, entries: Iterable[CopyEntry], known: Mapping[int, Telemetry]) -> Telemetry:
    name = COMBINED_PKT1 if msg_id == COMBINED_PKT1_MID else f"HK_COMBINED_{msg_id:04X}"
    found = [piece for entry in entries for piece in _pieces(entry, known.get(entry.input_mid))]
    pieces = sorted(found, key=lambda piece: piece.at)
    text = "Parts of other packets, as HK's copy table says that the mission starts with."
    return Telemetry(name, msg_id, Layout(name, _fields(pieces), packed=True), text)


def _pieces(entry: CopyEntry, source: Telemetry | None) -> Iterator[_Piece]:
    """Yield the pieces that an entry copies into the payload: whole fields, and bytes between them."""
    shift = entry.output_offset - entry.input_offset
    at = max(entry.input_offset, TLM_HEADER_SIZE - shift)  # bytes copied into the header belong to no field
    name = f"MID_{entry.input_mid:04X}" if source is None else source.name
    layout = None if source is None or source.payload.on_the_wire else source.payload
    for cell in () if layout is None else layout.cells():
        begin = TLM_HEADER_SIZE + cell.offset
        is_odd = cell.bit or cell.width % 8 or cell.big_endian
        if is_odd or begin < at or begin + cell.size > entry.input_end:
            continue
        if begin > at:
            yield _bytes(at, begin, shift, name)
        yield _Piece(begin + shift - TLM_HEADER_SIZE, cell.size, cell.names or cell.type, f"{name}_{cell.path}")
        at = begin + cell.size
    if at < entry.input_end:
        yield _bytes(at, entry.input_end, shift, name)


def _bytes(begin: int, end: int, shift: int, name: str) -> _Piece:
    return _Piece(begin + shift - TLM_HEADER_SIZE, end - begin, f"u8[{end - begin}]", f"{name}_from_{begin}")


def _fields(pieces: Iterable[_Piece]) -> Iterator[tuple[str, Any]]:
    """Yield names and types without gaps.

    If two overlap, the first stays. A field that is copied twice gets a number.
    """
    counts: dict[str, int] = {}
    at = 0
    for piece in pieces:
        if piece.at < at:
            continue
        if piece.at > at:
            yield f"spare_{at}", f"u8[{piece.at - at}]"
        name = re.sub(r"\W+", "_", piece.name).strip("_")
        counts[name] = counts.get(name, 0) + 1
        yield (name if counts[name] == 1 else f"{name}_{counts[name]}"), piece.kind
        at = piece.at + piece.size
