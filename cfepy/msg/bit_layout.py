"""Layouts with fields that are not whole bytes, or not in the byte order of the flight computer.

A `cfepy.msg.Layout` is a C struct. Electronic data sheets and ground databases also describe fields of 3 bits, numbers
with their highest byte first, and fields at any place. `BitLayout` has a place for each number and text, and the same
functions as a `Layout`, so that ground tools use it in the same way.
"""

from __future__ import annotations

import struct
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any, NamedTuple

from cfepy.msg.layout import Cell, Layout, Measurement, ValueNames
from cfepy.reading.suggestions import expected
from cfepy.reading.texts import from_bytes, to_bytes
from cfepy.status import UsageError

Step = str | int
"""A step from a struct to a field: the name of a field, or the index in an array."""


class FieldPlace(NamedTuple):
    """A number or text and where it is.

    Attributes:
        steps: the way to it, such as ("Masks", 2).
        kind: "u", "i" or "f" for a number, "bool", or "char" for a text.
        start: offset of its first bit from the start of the struct.
        bits: number of its bits; whole bytes for a text.
        big_endian: byte order of a number of several whole bytes. Other numbers have their highest bit first.
        names: the names of its values.
        measurement: its unit, calibration and limits.
    """

    steps: tuple[Step, ...]
    kind: str
    start: int
    bits: int
    big_endian: bool = True
    names: ValueNames | None = None
    measurement: Measurement | None = None

    @property
    def path(self) -> str:
        """The path in display form: "Masks[2]"."""
        text = ""
        for step in self.steps:
            text += f"[{step}]" if isinstance(step, int) else f".{step}" if text else step
        return text

    @property
    def type(self) -> str:
        """The word for its type, such as "u3", "f32", "bool" or "char[20]"."""
        if self.kind == "char":
            return f"char[{self.bits // 8}]"
        return "bool" if self.kind == "bool" else f"{self.kind}{self.bits}"

    @property
    def is_swapped(self) -> bool:
        """Whether its bytes stand in the reverse order in the struct."""
        return not self.big_endian and self.kind != "char" and self.bits > 8 and self.bits % 8 == 0

    def read(self, number: int, size: int) -> Any:
        """Return its value.

        Args:
            number: the bytes of the struct as a number, highest byte first.
            size: bytes of the struct.
        """
        raw = (number >> (8 * size - self.start - self.bits)) & ((1 << self.bits) - 1)
        if self.kind == "char":
            return from_bytes(raw.to_bytes(self.bits // 8, "big"))
        if self.is_swapped:
            raw = int.from_bytes(raw.to_bytes(self.bits // 8, "little"), "big")
        if self.kind == "f":
            return struct.unpack(_FLOATS[self.bits], raw.to_bytes(self.bits // 8, "big"))[0]
        if self.kind == "i" and raw >> (self.bits - 1):
            return raw - (1 << self.bits)
        return bool(raw) if self.kind == "bool" else raw

    def encoded(self, value: Any) -> int:
        """Return the bits of a value as a number, highest bit first.

        Raises:
            UsageError: for a value that does not fit; `field` is the path.
        """
        if self.kind == "char":
            return self._encoded_text(value)
        if isinstance(value, str) and self.names is not None:
            value = self._number_of(value)
        if not isinstance(value, int | float):
            raise UsageError(f"must be a number, not {value!r}", field=self.path)
        if self.kind == "f":
            raw = self._encoded_float(value)
        elif not isinstance(value, int):
            raise UsageError(f"must be an integer, not {value!r}", field=self.path)
        else:
            raw = self._encoded_integer(value)
        return int.from_bytes(raw.to_bytes(self.bits // 8, "little"), "big") if self.is_swapped else raw

    def _number_of(self, name: str) -> int:
        assert self.names is not None
        try:
            return self.names.number(name)
        except UsageError as error:
            raise UsageError(error.text, field=self.path) from None

    def _encoded_text(self, value: Any) -> int:
        if not isinstance(value, str | bytes | bytearray):
            raise UsageError(f"must be a text, not {value!r}", field=self.path)
        data, size = to_bytes(value) if isinstance(value, str) else bytes(value), self.bits // 8
        if len(data) > size:
            raise UsageError(f"must have at most {size} bytes, not {len(data)}: {value!r}", field=self.path)
        return int.from_bytes(data.ljust(size, b"\0"), "big")

    def _encoded_float(self, value: float) -> int:
        try:
            return int.from_bytes(struct.pack(_FLOATS[self.bits], value), "big")
        except OverflowError:
            raise UsageError(f"{value!r} does not fit {self.type}", field=self.path) from None

    def _encoded_integer(self, value: int) -> int:
        if self.kind == "bool":
            return int(bool(value))
        half = 1 << (self.bits - 1)
        low, high = (-half, half - 1) if self.kind == "i" else (0, 2 * half - 1)
        if not low <= value <= high:
            raise UsageError(f"{value!r} does not fit {self.type}; expected {low} to {high}", field=self.path)
        return value & (2 * half - 1)


_FLOATS = {32: ">f", 64: ">d"}


class BitLayout(Layout):
    """A struct whose fields have a place each.

    Args:
        name: the struct's name, for messages.
        places: the fields in order; the fields of an array or a nested struct stand together.
        size: bytes of the whole struct.

    >>> flags = BitLayout("Flags", [FieldPlace(("Mode",), "u", 0, 3), FieldPlace(("Count",), "u", 3, 13)], 2)
    >>> flags.pack(Mode=5, Count=2).hex(), flags.unpack(bytes([0xA0, 0x02]))
    ('a002', {'Mode': 5, 'Count': 2})
    """

    __slots__ = ("_known", "places")

    def __init__(self, name: str, places: Iterable[FieldPlace], size: int) -> None:
        super().__init__(name, ())
        self.places: tuple[FieldPlace, ...] = tuple(places)
        self._known: frozenset[tuple[Step, ...]] = frozenset(
            place.steps[:end] for place in self.places for end in range(1, len(place.steps) + 1)
        )
        self.size = size
        self.code = f"{size}s"
        self.leaves = 1
        self._struct = struct.Struct(self.code)
        ends: dict[str, int] = {}
        for place in self.places:
            field = str(place.steps[0])
            self.offsets.setdefault(field, place.start // 8)
            ends[field] = max(ends.get(field, 0), -(-(place.start + place.bits) // 8))
        self.sizes = {field: end - self.offsets[field] for field, end in ends.items()}

    @property
    def fields(self) -> tuple[str, ...]:
        """The names of the fields, in order."""
        return tuple(self.offsets)

    def flatten(self, value: Any, path: str) -> Iterator[bytes]:
        """Yield the bytes of the struct; see `Layout.flatten`."""
        if not isinstance(value, Mapping):
            raise UsageError(f"must be a mapping of the fields of {self.name}, not {value!r}", field=path)
        prefix = f"{path}." if path else ""
        unknown = [name for name in value if name not in self.offsets]
        if unknown:
            hint = expected(str(unknown[0]), self.offsets)
            raise UsageError(f"unknown field of {self.name}; {hint}", field=f"{prefix}{unknown[0]}")
        self._check_shapes(value, prefix)
        number, bits = 0, 8 * self.size
        for place in self.places:
            found = _value_at(value, place.steps)
            if found is not None:
                number |= self._encoded(place, found, prefix) << (bits - place.start - place.bits)
        yield number.to_bytes(self.size, "big")

    def build(self, leaves: Iterator[Any]) -> dict[str, Any]:
        """Return the values; see `Layout.build`."""
        number = int.from_bytes(next(leaves), "big")
        found: dict[Step, Any] = {}
        for place in self.places:
            holder = found
            for step in place.steps[:-1]:
                holder = holder.setdefault(step, {})
            holder[place.steps[-1]] = place.read(number, self.size)
        return {str(name): _with_lists(value) for name, value in found.items()}

    def cells(self, path: str = "", at: int = 0) -> Iterator[Cell]:
        """Yield every number and text in order; see `Layout.cells`."""
        prefix = f"{path}." if path else ""
        for place in self.places:
            offset, bit = divmod(place.start, 8)
            size = -(-(bit + place.bits) // 8)
            big = place.kind != "char" and not place.is_swapped and place.bits > 8
            more = (place.names, place.measurement, bit, place.bits, big)
            yield Cell(prefix + place.path, place.type, at + offset, size, *more)

    def put(self, cell: Cell, value: Any, payload: bytearray) -> None:
        """Write the value of one cell into a payload; see `Layout.put`."""
        place = next(each for each in self.places if each.path == cell.path)
        shift = 8 * self.size - place.start - place.bits
        number = int.from_bytes(payload, "big") & ~(((1 << place.bits) - 1) << shift)
        payload[:] = (number | (place.encoded(value) << shift)).to_bytes(self.size, "big")

    def _encoded(self, place: FieldPlace, value: Any, prefix: str) -> int:
        try:
            return place.encoded(value)
        except UsageError as error:
            raise UsageError(error.text, field=f"{prefix}{place.path}") from None

    def _check_shapes(self, value: Mapping[str, Any], prefix: str) -> None:
        """Check that lists and mappings of a value have no more items than the layout.

        Raises:
            UsageError: naming the first one that has.
        """
        for steps in _steps_in(value, ()):
            if steps not in self._known:
                path = FieldPlace(steps, "u", 0, 1).path
                raise UsageError(f"has no place in {self.name}; remove it", field=f"{prefix}{path}")

    def _misfit(self, value: Mapping[str, Any]) -> UsageError:
        return UsageError(f"the values do not fit {self.name}")


def _steps_in(value: Any, steps: tuple[Step, ...]) -> Iterator[tuple[Step, ...]]:
    if steps:
        yield steps
    if isinstance(value, Mapping):
        for name, inner in value.items():
            yield from _steps_in(inner, (*steps, name))
    elif isinstance(value, Sequence) and not isinstance(value, str | bytes | bytearray):
        for number, inner in enumerate(value):
            yield from _steps_in(inner, (*steps, number))


def _value_at(value: Any, steps: Sequence[Step]) -> Any:
    """Return the value at the end of the steps; None if it is not given."""
    for step in steps:
        if isinstance(step, int):
            value = value[step] if isinstance(value, Sequence) and step < len(value) else None
        else:
            value = value.get(step) if isinstance(value, Mapping) else None
        if value is None:
            return None
    return value


def _with_lists(value: Any) -> Any:
    """Return nested values with lists in place of the mappings from indices."""
    if not isinstance(value, dict):
        return value
    inner = [_with_lists(each) for each in value.values()]
    return inner if all(isinstance(step, int) for step in value) else dict(zip(value, inner, strict=True))
