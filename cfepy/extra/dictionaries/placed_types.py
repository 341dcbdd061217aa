"""The types of packets and tables, as all sources of a dictionary give them, and where their fields are.

A type has a place for each number in two forms. On the wire the fields stand one behind the other, in the byte order
that the source declares. In the memory of the flight computer, as a C application has them on the Software Bus, numbers
of 8, 16, 32 and 64 bits are aligned and have their lowest byte first; smaller ones share bytes.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

from cfepy.msg import BitLayout, FieldPlace, Layout, Measurement, ValueNames

MOST_BITS = 8 << 20
"""The largest type: 1 MiB."""
MOST_CELLS = 100_000
"""The most numbers and texts of a type."""
_WHOLE = {"u": (8, 16, 32, 64), "i": (8, 16, 32, 64), "f": (32, 64), "bool": (8,)}


class Number(NamedTuple):
    """A number: `kind` is "u", "i", "f" or "bool"; `big_endian` is its byte order on the wire."""

    kind: str
    bits: int
    big_endian: bool = True
    names: ValueNames | None = None
    measurement: Measurement | None = None

    @property
    def is_whole(self) -> bool:
        """Whether C has such a type."""
        return self.bits in _WHOLE[self.kind]

    @property
    def word(self) -> str:
        """The word of `cfepy.msg.Layout` for it, such as "u16"."""
        return "bool" if self.kind == "bool" else f"{self.kind}{self.bits}"


class Text(NamedTuple):
    """A text of at most `size` bytes, filled up with NULs."""

    size: int


class Padding(NamedTuple):
    """Bits without meaning."""

    bits: int


class Array(NamedTuple):
    """A fixed number of equal items."""

    item: Type
    length: int


class StructEntry(NamedTuple):
    """A field of a struct: `line` is where its source declares it, `fixed` the value that it always has."""

    name: str
    type: Type
    line: int = 0
    text: str = ""
    fixed: int | float | str | None = None


class Struct(NamedTuple):
    """A struct with its fields in order; padding has the name ""."""

    name: str
    fields: tuple[StructEntry, ...]


Type = Number | Text | Padding | Array | Struct


def bits_of(kind: Type) -> int:
    """Return the bits of a type on the wire."""
    if isinstance(kind, Text):
        return 8 * kind.size
    if isinstance(kind, Array):
        return kind.length * bits_of(kind.item)
    if isinstance(kind, Struct):
        return sum(bits_of(field.type) for field in kind.fields)
    return kind.bits


def cells_of(kind: Type) -> int:
    """Return how many numbers and texts a type has."""
    if isinstance(kind, Array):
        return kind.length * cells_of(kind.item)
    if isinstance(kind, Struct):
        return sum(cells_of(field.type) for field in kind.fields)
    return 0 if isinstance(kind, Padding) else 1


def wire_layout(struct: Struct) -> BitLayout:
    """Return a struct as it stands on the wire."""
    places: list[FieldPlace] = []
    end = _put_on_wire(struct, (), 0, places)
    return BitLayout(struct.name, places, -(-end // 8))


def _put_on_wire(kind: Type, steps: tuple[str | int, ...], at: int, places: list[FieldPlace]) -> int:
    for inner, way in _parts(kind, steps):
        at = _put_on_wire(inner, way, at, places)
    if isinstance(kind, Number | Text):
        places.append(_place(kind, steps, at, big_endian=isinstance(kind, Text) or kind.big_endian))
    return at + (0 if isinstance(kind, Array | Struct) else bits_of(kind))


def memory_layout(struct: Struct) -> Layout:
    """Return a struct as a C application has it in memory: a plain layout, if its fields are all of C's types."""
    places: list[FieldPlace] = []
    end = -(-_put_in_memory(struct, (), 0, places) // 8)
    layout = BitLayout(struct.name, places, end)
    plain = _plain(struct)
    if plain is not None and plain.size == end and _shape(plain) == _shape(layout):
        return plain
    return layout


def _shape(layout: Layout) -> list[tuple[str, str, int, int]]:
    return [(cell.path, cell.type, cell.offset, cell.bit) for cell in layout.cells()]


def _put_in_memory(kind: Type, steps: tuple[str | int, ...], at: int, places: list[FieldPlace]) -> int:
    alignment = _alignment(kind)
    at += -at % alignment
    for inner, way in _parts(kind, steps):
        at = _put_in_memory(inner, way, at, places)
    if isinstance(kind, Number | Text):
        places.append(_place(kind, steps, at, big_endian=isinstance(kind, Text) or not kind.is_whole))
    at += 0 if isinstance(kind, Array | Struct) else bits_of(kind)
    return at + (-at % alignment if isinstance(kind, Struct) else 0)


def _alignment(kind: Type) -> int:
    """Return the alignment of a type in memory, in bits."""
    if isinstance(kind, Array):
        return _alignment(kind.item)
    if isinstance(kind, Struct):
        return max((8, *(_alignment(field.type) for field in kind.fields)))
    if isinstance(kind, Number):
        return kind.bits if kind.is_whole else 1
    return 8 if isinstance(kind, Text) else 1


def _parts(kind: Type, steps: tuple[str | int, ...]) -> Iterator[tuple[Type, tuple[str | int, ...]]]:
    if isinstance(kind, Array):
        yield from ((kind.item, (*steps, number)) for number in range(kind.length))
    elif isinstance(kind, Struct):
        yield from ((field.type, (*steps, field.name)) for field in kind.fields)


def _place(kind: Number | Text, steps: tuple[str | int, ...], at: int, big_endian: bool) -> FieldPlace:
    if isinstance(kind, Text):
        return FieldPlace(steps, "char", at, 8 * kind.size)
    return FieldPlace(steps, kind.kind, at, kind.bits, big_endian, kind.names, kind.measurement)


def _plain(kind: Type) -> Layout | None:
    """Return a struct as a plain layout without its padding; None if it has other types than C's."""
    if not isinstance(kind, Struct):
        return None
    fields = []
    for field in kind.fields:
        if isinstance(field.type, Padding):
            continue
        word = _word(field.type)
        if word is None:
            return None
        fields.append((field.name, word))
    return Layout(kind.name, fields)


def _word(kind: Type) -> object | None:
    """Return the type of a field for `Layout`; None if it has none."""
    if isinstance(kind, Number):
        return (kind.measurement or kind.names or kind.word) if kind.is_whole else None
    if isinstance(kind, Text):
        return f"char[{kind.size}]"
    if isinstance(kind, Struct):
        return _plain(kind)
    if isinstance(kind, Array):
        item = _word(kind.item)
        return None if item is None else (item, kind.length)
    return None


def without_wrapper(struct: Struct) -> Struct:
    """Return the inner struct of a struct that has only a member such as `Payload`, otherwise the struct."""
    if len(struct.fields) == 1 and isinstance(struct.fields[0].type, Struct):
        return struct.fields[0].type
    return struct


def lines_of(struct: Struct, path: str = "") -> dict[str, int]:
    """Return the lines of the fields of a struct, by path without indices."""
    found: dict[str, int] = {}
    for each in struct.fields:
        if not each.name:
            continue
        inner = f"{path}.{each.name}" if path else each.name
        found[inner] = each.line
        kind = each.type
        while isinstance(kind, Array):
            kind = kind.item
        if isinstance(kind, Struct):
            found |= lines_of(kind, inner)
    return found
