"""Layouts from items that a ground database puts at bits of a whole packet."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from cfepy.msg import CMD_HEADER_SIZE, TLM_HEADER_SIZE, BitLayout, FieldPlace, Layout


def payload_of(name: str, places: Iterable[FieldPlace], bits: int, is_command: bool) -> Layout:
    """Return the layout of a packet after its header; a plain layout, if its fields are like a C struct's.

    Args:
        name: name of the packet.
        places: the items of the whole packet.
        bits: bits of the whole packet.
        is_command: whether it is a command.
    """
    header = 8 * (CMD_HEADER_SIZE if is_command else TLM_HEADER_SIZE)
    inner = [place._replace(start=place.start - header) for place in places if place.start >= header]
    return plain_or_bits(name, inner, max(-(-(bits - header) // 8), 0))


def plain_or_bits(name: str, places: Sequence[FieldPlace], size: int) -> Layout:
    """Return a plain layout if a C struct without nested structs has the same places, otherwise a `BitLayout`."""
    layout = BitLayout(name, places, size)
    plain = _plain(name, places)
    same = plain is not None and plain.size == size and _shape(plain) == _shape(layout)
    return plain if plain is not None and same else layout


def _shape(layout: Layout) -> list[tuple[str, str, int, bool]]:
    return [(each.path, each.type, each.offset, each.big_endian) for each in layout.cells()]


def _plain(name: str, places: Sequence[FieldPlace]) -> Layout | None:
    fields: dict[str, object] = {}
    counts: dict[str, int] = {}
    for place in places:
        field, *indices = place.steps
        if not isinstance(field, str) or len(indices) > 1 or not all(isinstance(each, int) for each in indices):
            return None
        if place.kind in "ui" and place.bits not in (8, 16, 32, 64):
            return None
        fields[field] = place.measurement or place.names or place.type
        counts[field] = counts.get(field, 0) + len(indices)
    if any(kind == "bool" for kind in fields.values()) and any(p.kind == "bool" and p.bits != 8 for p in places):
        return None
    return Layout(name, [(field, (kind, counts[field]) if counts[field] else kind) for field, kind in fields.items()])


def header_value(ids: Iterable[tuple[FieldPlace, int]], start: int, bits: int) -> int:
    """Return the value of bits of a header, from the items that are there.

    Args:
        ids: items of the header and their values.
        start: the first bit.
        bits: number of bits.
    """
    number = 0
    for place, value in ids:
        shift = start + bits - place.start - place.bits
        if start <= place.start and shift >= 0:
            number |= (value & ((1 << place.bits) - 1)) << shift
        elif place.start <= start and place.start + place.bits >= start + bits:
            number |= (value >> -shift) & ((1 << bits) - 1)
    return number
