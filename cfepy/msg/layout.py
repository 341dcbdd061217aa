"""Payload layouts: a C struct declared once, then packed and unpacked like NASA's x86-64 build has it in memory.

Structs have natural C alignment and are little-endian. A layout compiles to one `struct.Struct` over all its leaves,
including nested structs and arrays. Packing lines up the values for it, and unpacking builds a dict from them.

A field's type is one of u8 i8 u16 i16 u32 i32 u64 i64 f32 f64 bool, `char[N]` (text of at most N bytes), another
Layout, or an array of these: "u16[4]", "u8[2][3]", "char[4][20]" (4 texts of 20), `(Layout, 32)`. An integer with named
values is `ValueNames("u8", SHORT=0, LONG=1)`. Packing also accepts the names; unpacking gives the number. A number that
measures something is `Measurement("u16", "degC", polynomial=(-40, 0.5), red=(-20, 70))`. Packing and unpacking have its
raw number; ground tools show the value with its unit, and mark it if it is outside its limits.

Two types that all services use are here too. One is a spacecraft time (`SYS_TIME`). The other is text in a field of
fixed size (CFE_SB_MessageStringSet, CFE_SB_MessageStringGet): it is padded with NULs, and has no NUL if it fills its
field.
"""

from __future__ import annotations

import re
import struct
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, NamedTuple

from cfepy.msg.header import Packet
from cfepy.reading.suggestions import FEW, did_you_mean, expected, listed
from cfepy.reading.texts import from_bytes, to_bytes
from cfepy.status import CFE_SB_BAD_ARGUMENT, CFE_STATUS_WRONG_MSG_LENGTH, CfeError, UsageError

_SCALARS = {
    "u8": ("B", 1),
    "i8": ("b", 1),
    "u16": ("H", 2),
    "i16": ("h", 2),
    "u32": ("I", 4),
    "i32": ("i", 4),
    "u64": ("Q", 8),
    "i64": ("q", 8),
    "f32": ("f", 4),
    "f64": ("d", 8),
    "bool": ("?", 1),
}
_TYPE = re.compile(r"(\w+)((?:\[\d+\])*)")


class ValueNames:
    """An integer with named values: an enumeration in C, or bits of a mask.

    Args:
        type: type of the integer, such as "u8".
        flags: whether each value is a bit, so that several can be given, as in ERROR+CRITICAL.
        values: the names, without their common prefix in C.
    """

    __slots__ = ("_texts", "flags", "type", "values")

    def __init__(self, type: str, /, *, flags: bool = False, **values: int) -> None:
        self.type = type
        self.flags = flags
        self.values: Mapping[str, int] = values
        self._texts = {number: name for name, number in values.items()}

    @classmethod
    def of(cls, type: str, values: Mapping[str, int]) -> ValueNames:
        """Return an integer whose names, such as "flags" or "On/Off", may be any text."""
        made = cls(type)
        made.values = dict(values)
        made._texts = {number: name for name, number in values.items()}
        return made

    def number(self, text: str) -> int:
        """Return the value of a name, in upper or lower case.

        Raises:
            UsageError: if there is no such name.
        """
        total = 0
        for part in text.split("+") if self.flags else [text]:
            number = self.values.get(part.upper(), self.values.get(part))
            if number is None:
                number = next((value for name, value in self.values.items() if name.upper() == part.upper()), None)
            if number is None:
                raise UsageError(f"unknown value {part!r}; {self._expected(part)}")
            total |= number
        return total

    def _expected(self, name: str) -> str:
        hint = did_you_mean(name, self.values)
        if len(self.values) > FEW:
            return hint or f"expected {listed(self.values)}"
        return f"{hint} (expected one of {self})" if hint else f"expected one of {self}"

    def text(self, number: int) -> str:
        """Return the name of a value, or the number if it has none."""
        if not self.flags or not number:
            return self._texts.get(number, str(number))
        names = [name for name, value in self.values.items() if value & number]
        return "+".join(names) if sum(self.values[name] for name in names) == number else str(number)

    def __str__(self) -> str:
        return ", ".join(f"{name} ({value})" for name, value in self.values.items())


RED, YELLOW = "red", "yellow"
"""The limits of a measurement."""

Limits = tuple[float | None, float | None]
"""The lowest and the highest good value; None for no limit on that side."""


@dataclass(frozen=True, slots=True)
class Measurement:
    """A number that measures something: a raw number in the packet, and its engineering value on the ground.

    Args:
        type: type of the raw number, such as "u16".
        unit: unit of the value, such as "V".
        polynomial: calibration by the coefficients for the powers 0, 1, 2 and so on of the raw number.
        points: calibration by (raw, value) pairs, with rising raw numbers and straight lines between them.
        yellow: limits for a warning.
        red: limits for an alarm.

    Raises:
        UsageError: if they do not fit together.

    >>> voltage = Measurement("u8", "V", polynomial=(0.0, 0.2), yellow=(24, None), red=(22, None))
    >>> [voltage.text(raw) for raw in (130, 115, 100)]
    ['26V', '23V[yellow<24]', '20V[red<22]']
    """

    type: str
    unit: str = ""
    polynomial: tuple[float, ...] = ()
    points: tuple[tuple[float, float], ...] = ()
    yellow: Limits | None = None
    red: Limits | None = None

    def __post_init__(self) -> None:
        if self.type not in _SCALARS or self.type == "bool":
            raise UsageError(f"invalid type {self.type!r} of a measurement; expected a number, such as u16 or f32")
        if self.polynomial and self.points:
            raise UsageError("polynomial cannot be combined with points; give one calibration")
        raws = [raw for raw, _ in self.points]
        if self.points and (len(raws) < 2 or sorted(set(raws)) != raws):
            raise UsageError("points must be at least two, with rising raw numbers")
        for name in (YELLOW, RED):
            low, high = self.limits(name)
            if low is not None and high is not None and low > high:
                raise UsageError(f"{name} must be (LOWEST, HIGHEST), not {(low, high)}")
        (low, high), (inner_low, inner_high) = self.limits(RED), self.limits(YELLOW)
        is_low_inside = low is not None and inner_low is not None and low > inner_low
        if is_low_inside or (high is not None and inner_high is not None and high < inner_high):
            raise UsageError("the red limits must include the yellow ones")

    @property
    def is_calibrated(self) -> bool:
        """Whether the value is another one than the raw number."""
        return bool(self.polynomial or self.points)

    @property
    def has_limits(self) -> bool:
        """Whether a value can violate a limit."""
        return any(limit is not None for name in (RED, YELLOW) for limit in self.limits(name))

    def limits(self, name: str) -> Limits:
        """Return the limits of a name, `RED` or `YELLOW`."""
        return (self.red if name == RED else self.yellow) or (None, None)

    def value(self, raw: float) -> float:
        """Return the engineering value of a raw number; beyond the outer points, their lines continue."""
        if self.polynomial:
            total = 0.0
            for coefficient in reversed(self.polynomial):
                total = total * raw + coefficient
            return total
        if not self.points:
            return raw
        at = next((at for at, (end, _) in enumerate(self.points[1:-1], 1) if raw < end), len(self.points) - 1)
        (first, low), (last, high) = self.points[at - 1 : at + 1]
        return low + (raw - first) * (high - low) / (last - first)

    def violated(self, value: float) -> str:
        """Return the limit that a value violates, `RED` before `YELLOW`; empty if it is good. NaN violates each."""
        for name in (RED, YELLOW):
            low, high = self.limits(name)
            if (low is not None and not value >= low) or (high is not None and not value <= high):
                return name
        return ""

    def text(self, raw: float) -> str:
        """Return the value with its unit, and a mark if it violates a limit, such as 85.2V[red>80]."""
        value = self.value(raw)
        name = self.violated(value)
        low, high = self.limits(name)
        mark = f"[{name}<{low:g}]" if low is not None and not value >= low else f"[{name}>{high:g}]" if name else ""
        return f"{value:.7g}{self.unit}{mark}"

    def explained(self, value: float) -> str:
        """Return a sentence about a value that violates a limit."""
        name = self.violated(value)
        low, high = self.limits(name)
        unit = f" {self.unit}" if self.unit else ""
        is_low = low is not None and not value >= low
        limit = f"below the {name} limit of {low:g}" if is_low else f"above the {name} limit of {high:g}"
        return f"{value:.7g}{unit}, {limit}{unit}"


class Cell(NamedTuple):
    """A number or text of a struct: `path` is "PacketID.AppName" or "Counts[3]", `type` is "u16" or "char[20]".

    A number of a `cfepy.msg.BitLayout` may have any number of bits, such as "u3". Then `bit` counts the bits before it
    in the byte at `offset`, `bits` are its own, and `size` is the number of bytes that it touches. `big_endian` is its
    byte order.
    """

    path: str
    type: str
    offset: int
    size: int
    names: ValueNames | None = None
    measurement: Measurement | None = None
    bit: int = 0
    bits: int = 0
    big_endian: bool = False

    @property
    def width(self) -> int:
        """Its number of bits."""
        return self.bits or 8 * self.size

    @property
    def start(self) -> int:
        """Its first bit in the struct."""
        return 8 * self.offset + self.bit


class _Scalar:
    """A number or a bool."""

    __slots__ = ("align", "code", "leaves", "measurement", "names", "size")

    def __init__(
        self, code: str, size: int, names: ValueNames | None = None, measurement: Measurement | None = None
    ) -> None:
        self.names: ValueNames | None = names
        self.measurement: Measurement | None = measurement
        self.code: str = code
        self.size: int = size
        self.align: int = size
        self.leaves: int = 1

    def flatten(self, value: Any, path: str) -> Iterator[Any]:
        if not isinstance(value, (int, float)):
            if self.names is None or not isinstance(value, str):
                raise UsageError(f"must be a number, not {value!r}", field=path)
            value = _named(self.names, value, path)
        if self.code not in "fd" and not isinstance(value, int):
            raise UsageError(f"must be an integer, not {value!r}", field=path)
        yield value

    def build(self, leaves: Iterator[Any]) -> Any:
        return next(leaves)

    def cells(self, path: str, at: int) -> Iterator[Cell]:
        yield Cell(path, _name_of_code(self.code), at, self.size, self.names, self.measurement)

    def zero(self) -> Any:
        return 0


class _Text:
    """char[N]: text up to the first NUL, in UTF-8; other bytes survive a round trip as surrogates."""

    __slots__ = ("align", "code", "leaves", "size")

    def __init__(self, size: int) -> None:
        self.code: str = f"{size}s"
        self.size: int = size
        self.align: int = 1
        self.leaves: int = 1

    def flatten(self, value: Any, path: str) -> Iterator[Any]:
        if not isinstance(value, (str, bytes, bytearray)):
            raise UsageError(f"must be a text, not {value!r}", field=path)
        data = to_bytes(value) if isinstance(value, str) else bytes(value)
        if len(data) > self.size:
            raise UsageError(f"must have at most {self.size} bytes, not {len(data)}: {value!r}", field=path)
        yield data

    def build(self, leaves: Iterator[Any]) -> Any:
        text: bytes = next(leaves)
        return from_bytes(text)

    def cells(self, path: str, at: int) -> Iterator[Cell]:
        yield Cell(path, f"char[{self.size}]", at, self.size)

    def zero(self) -> Any:
        return b""


class _Array:
    """A fixed number of equal items; a shorter sequence is padded with zeros."""

    __slots__ = ("align", "code", "count", "item", "leaves", "size")

    def __init__(self, item: _Type, count: int) -> None:
        self.item: _Type = item
        self.count: int = count
        self.code: str = item.code * count
        self.size: int = item.size * count
        self.align: int = item.align
        self.leaves: int = item.leaves * count

    def flatten(self, value: Any, path: str) -> Iterator[Any]:
        if not isinstance(value, (Sequence, memoryview, bytearray)) or isinstance(value, str):
            raise UsageError(f"must be a list, not {value!r}", field=path)
        if len(value) > self.count:
            raise UsageError(f"must have at most {self.count} items, not {len(value)}", field=path)
        for number in range(self.count):
            item = value[number] if number < len(value) else self.item.zero()
            yield from self.item.flatten(item, f"{path}[{number}]")

    def build(self, leaves: Iterator[Any]) -> Any:
        return [self.item.build(leaves) for _ in range(self.count)]

    def cells(self, path: str, at: int) -> Iterator[Cell]:
        for number in range(self.count):
            yield from self.item.cells(f"{path}[{number}]", at + number * self.item.size)

    def zero(self) -> Any:
        return ()


class Layout:
    """A C struct.

    Args:
        name: the struct's name, for messages.
        fields: (name, type) pairs in order, types as the module says.
        on_the_wire: big-endian and without padding, as an application packs it by hand; for a payload, not for a struct
            inside of another one.
        packed: without padding, as `__attribute__((packed))` of C compilers.

    Attributes:
        size: bytes, padding at the end included (sizeof).
        align: the strictest alignment of a field.
        offsets: field name to offset in bytes.
        sizes: field name to size in bytes.

    >>> point = Layout("Point", [("Id", "u8"), ("X", "i32"), ("Name", "char[3]")])
    >>> point.size, point.offsets
    (12, {'Id': 0, 'X': 4, 'Name': 8})
    >>> point.unpack(point.pack(Id=7, X=-1, Name="ab"))
    {'Id': 7, 'X': -1, 'Name': 'ab'}
    """

    __slots__ = ("_fields", "_struct", "align", "code", "leaves", "name", "offsets", "on_the_wire", "size", "sizes")

    def __init__(
        self, name: str, fields: Iterable[tuple[str, Any]], *, on_the_wire: bool = False, packed: bool = False
    ) -> None:
        self.name: str = name
        self.on_the_wire: bool = on_the_wire
        self._fields: dict[str, _Type] = {}
        for field, kind in fields:
            if field in self._fields:
                raise UsageError("is declared twice", field=f"{name}.{field}")
            self._fields[field] = _parse_type(kind, f"{name}.{field}")
        self.sizes: dict[str, int] = {field: kind.size for field, kind in self._fields.items()}
        aligns = [] if on_the_wire or packed else [kind.align for kind in self._fields.values()]
        self.align: int = max(aligns, default=1)
        self.leaves: int = sum(kind.leaves for kind in self._fields.values())
        self._place()
        self._struct = struct.Struct((">" if on_the_wire else "<") + self.code)

    def _place(self) -> None:
        """Give every field its offset, with the padding of a C compiler."""
        self.offsets: dict[str, int] = {}
        codes: list[str] = []
        at = 0
        for field, kind in self._fields.items():
            padding = -at % min(kind.align, self.align)
            codes += [f"{padding}x"] * bool(padding) + [kind.code]
            self.offsets[field] = at + padding
            at += padding + kind.size
        padding = -at % self.align
        self.code: str = "".join(codes) + (f"{padding}x" if padding else "")
        self.size: int = at + padding

    @property
    def fields(self) -> tuple[str, ...]:
        """The names of the fields, in order."""
        return tuple(self._fields)

    @property
    def is_packed(self) -> bool:
        """Whether it has no padding although its fields would have some in C."""
        return self.align == 1 and not self.on_the_wire and any(kind.align > 1 for kind in self._fields.values())

    def types(self) -> Iterator[tuple[str, Any]]:
        """Yield the fields as a declaration has them: names with types."""
        return ((name, _declared_type(kind)) for name, kind in self._fields.items())

    def pack(self, values: Mapping[str, Any] | None = None, /, **more: Any) -> bytes:
        """Return the struct's bytes; a field not given is zero.

        Args:
            values: field values as a mapping, and
            more: as keywords. Nested structs are mappings, arrays are sequences.

        Raises:
            UsageError: an unknown field, or a value that does not fit; `field` is its path.
        """
        given = {**values, **more} if values else more
        leaves = list(self.flatten(given, ""))
        try:
            return self._struct.pack(*leaves)
        except (struct.error, OverflowError):
            raise self._misfit(given) from None

    def unpack(self, buffer: bytes | bytearray | memoryview, offset: int = 0) -> dict[str, Any]:
        """Return the values of a struct that starts at `offset` of a buffer: numbers, texts, lists, dicts.

        Raises:
            CfeError: CFE_STATUS_WRONG_MSG_LENGTH if the buffer ends too early.
        """
        try:
            leaves = self._struct.unpack_from(buffer, offset)
        except struct.error:
            text = f"{self.name} requires {self.size} bytes at offset {offset}, but the buffer has {len(buffer)}"
            raise CfeError(CFE_STATUS_WRONG_MSG_LENGTH, text) from None
        return self.build(iter(leaves))

    def flatten(self, value: Any, path: str) -> Iterator[Any]:
        """Yield the leaf values of this struct in order, for the enclosing struct."""
        if not isinstance(value, Mapping):
            raise UsageError(f"must be a mapping of the fields of {self.name}, not {value!r}", field=path)
        prefix = f"{path}." if path else ""
        if not value.keys() <= self._fields.keys():
            unknown = next(name for name in value if name not in self._fields)
            hint = expected(str(unknown), self._fields)
            raise UsageError(f"unknown field of {self.name}; {hint}", field=f"{prefix}{unknown}")
        for field, kind in self._fields.items():
            yield from kind.flatten(value[field] if field in value else kind.zero(), prefix + field)

    def build(self, leaves: Iterator[Any]) -> dict[str, Any]:
        """Return this struct's values, taken from the leaves of the enclosing struct."""
        return {field: kind.build(leaves) for field, kind in self._fields.items()}

    def cells(self, path: str = "", at: int = 0) -> Iterator[Cell]:
        """Yield every number and text in order, including those of nested structs and arrays, for tools.

        Args:
            path: path of this struct in the enclosing struct.
            at: offset of this struct in bytes.
        """
        prefix = f"{path}." if path else ""
        for field, kind in self._fields.items():
            yield from kind.cells(prefix + field, at + self.offsets[field])

    def put(self, cell: Cell, value: Any, payload: bytearray) -> None:
        """Write the value of one cell into a payload of this struct.

        Args:
            cell: one of `cells`.
            value: its value.
            payload: the bytes of the whole struct.

        Raises:
            UsageError: for a value that does not fit; `field` is the cell's path.
        """
        try:
            data = Layout(cell.path, [("value", cell.type)], on_the_wire=self.on_the_wire).pack(value=value)
        except UsageError as error:
            raise UsageError(error.text, field=cell.path) from None
        payload[cell.offset : cell.offset + cell.size] = data

    def zero(self) -> dict[str, Any]:
        """Return the value of an all-zero struct."""
        return {}

    def _misfit(self, value: Mapping[str, Any]) -> UsageError:
        """Return the error for the first field that does not fit, found by packing each leaf alone."""
        for path, code, leaf in _leaves(self, value, ""):
            try:
                struct.pack("<" + code, leaf)
            except (struct.error, OverflowError):
                return UsageError(f"{leaf!r} does not fit {_name_of_code(code)}{_range_of(code)}", field=path)
        return UsageError(f"the values do not fit {self.name}")

    def __repr__(self) -> str:
        return f"Layout({self.name!r}, size={self.size})"


_Type = _Scalar | _Text | _Array | Layout


def _parse_type(kind: Any, path: str) -> _Type:
    if isinstance(kind, Layout):
        return kind
    if isinstance(kind, ValueNames):
        return _Scalar(*_SCALARS[kind.type], kind)
    if isinstance(kind, Measurement):
        return _Scalar(*_SCALARS[kind.type], measurement=kind)
    if isinstance(kind, tuple):
        return _Array(_parse_type(kind[0], path), kind[1])
    match = _TYPE.fullmatch(kind)
    if match is None or match[1] not in {*_SCALARS, "char"}:
        hint = did_you_mean(kind, [*_SCALARS, "char[N]"], before="; ")
        raise UsageError(
            f"invalid type {kind!r}; expected {', '.join(_SCALARS)}, char[N] or a Layout{hint}", field=path
        )
    counts = [int(count) for count in re.findall(r"\d+", match[2])]
    parsed: _Type = _Text(counts.pop() if counts else 1) if match[1] == "char" else _Scalar(*_SCALARS[match[1]])
    for count in reversed(counts):
        parsed = _Array(parsed, count)
    return parsed


def _declared_type(kind: _Type) -> Any:
    """Return a type in the form of a declaration."""
    if isinstance(kind, _Array):
        return _declared_type(kind.item), kind.count
    if isinstance(kind, _Scalar):
        return kind.measurement or kind.names or _name_of_code(kind.code)
    return f"char[{kind.size}]" if isinstance(kind, _Text) else kind


def _leaves(kind: _Type, value: Any, path: str) -> Iterator[tuple[str, str, Any]]:
    """Yield (path, struct code, value) of every given leaf."""
    if isinstance(kind, Layout):
        for field, inner in kind._fields.items():
            if field in value:
                yield from _leaves(inner, value[field], f"{path}.{field}" if path else field)
    elif isinstance(kind, _Array):
        for number, item in enumerate(value):
            yield from _leaves(kind.item, item, f"{path}[{number}]")
    else:
        yield path, kind.code, next(kind.flatten(value, path))


def _named(names: ValueNames, text: str, path: str) -> int:
    try:
        return names.number(text)
    except UsageError as error:
        raise UsageError(error.text, field=path) from None


def _name_of_code(code: str) -> str:
    return next((name for name, (known, _) in _SCALARS.items() if known == code), f"char[{code[:-1]}]")


def _range_of(code: str) -> str:
    """Return the range of an integer for an error; empty for another type."""
    if code not in "bBhHiIqQ":
        return ""
    bits = 8 * struct.calcsize(f"<{code}")
    lowest, highest = (0, (1 << bits) - 1) if code.isupper() else (-(1 << (bits - 1)), (1 << (bits - 1)) - 1)
    return f"; expected {lowest} to {highest}"


SYS_TIME = Layout("CFE_TIME_SysTime_t", [("Seconds", "u32"), ("Subseconds", "u32")])


def sys_time_fields(time: tuple[int, int]) -> dict[str, int]:
    """Return a time (seconds, subseconds of 2**-32 s) as the fields of SYS_TIME."""
    return {"Seconds": time[0], "Subseconds": time[1]}


def message_string_set(text: str, size: int) -> bytes:
    """Return the bytes of a text field: cut to `size`, or filled up with NULs (CFE_SB_MessageStringSet).

    Raises:
        CfeError: CFE_SB_BAD_ARGUMENT for a negative size.
    """
    if size < 0:
        raise CfeError(CFE_SB_BAD_ARGUMENT, f"invalid size of a text field: {size} bytes")
    return to_bytes(text)[:size].ljust(size, b"\0")


def message_string_get(field: Packet, size: int, default: str | None = None) -> str:
    """Return the text of a field, short enough for a C buffer of `size` bytes (CFE_SB_MessageStringGet).

    Args:
        field: the bytes of the field; the text ends at the first NUL or where the field ends.
        size: bytes of the buffer, including its final NUL.
        default: used if the field is empty.

    Raises:
        CfeError: CFE_SB_BAD_ARGUMENT for a size of 0.
    """
    if size <= 0:
        raise CfeError(CFE_SB_BAD_ARGUMENT, "a text buffer must have at least one byte")
    data = bytes(field).partition(b"\0")[0]
    if not data and default is not None:
        data = to_bytes(default)
    return from_bytes(data[: size - 1])
