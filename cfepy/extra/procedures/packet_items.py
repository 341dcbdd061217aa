"""Packets of a ground system: items at bits of the whole packet, with states, limits and conversions as in COSMOS."""

from __future__ import annotations

import struct
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Literal

from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError

RAW, CONVERTED, FORMATTED, WITH_UNITS = "RAW", "CONVERTED", "FORMATTED", "WITH_UNITS"
VALUE_TYPES = (RAW, CONVERTED, FORMATTED, WITH_UNITS)
HEADER = frozenset({"CCSDS_STREAMID", "CCSDS_SEQUENCE", "CCSDS_LENGTH", "CCSDS_FC", "CCSDS_CHECKSUM"})


@dataclass(slots=True)
class Item:
    """An item of a packet.

    Attributes:
        name: its name, in capitals.
        kind: "u", "i", "f", "char", "block" or "bool".
        start: the first bit in the whole packet.
        bits: number of bits; of one element for an array; 0 for a text or block up to the end of the packet.
        big_endian: byte order.
        count: number of elements of an array; 0 for a single value.
        default: the value of a parameter that a command does not give.
        low, high: the valid range of a parameter; None without one.
        states: values by the names of states.
        hazardous: states that make a command hazardous, with their descriptions.
        required: whether a command must give the parameter.
        text: description.
        units: short name of the unit.
        format: printf format, or empty.
        polynomial: coefficients of the conversion to engineering units.
        segments: lower ends of segments and their coefficients, highest first.
        limits: red low, yellow low, yellow high, red high by limits set.
    """

    name: str
    kind: str
    start: int
    bits: int
    big_endian: bool = False
    count: int = 0
    default: Any = 0
    low: float | None = None
    high: float | None = None
    states: dict[str, int] = field(default_factory=dict)
    hazardous: dict[str, str] = field(default_factory=dict)
    required: bool = False
    text: str = ""
    units: str = ""
    format: str = ""
    polynomial: tuple[float, ...] = ()
    segments: list[tuple[float, tuple[float, ...]]] = field(default_factory=list)
    limits: dict[str, tuple[float, ...]] = field(default_factory=dict)

    @property
    def end(self) -> int:
        """The bit after the item."""
        return self.start + self.bits * (self.count or 1)

    def read(self, data: bytes, value_type: str = CONVERTED) -> Any:
        """Return the item's value in a packet, or None if the packet is too short.

        Args:
            data: the whole packet.
            value_type: "RAW", "CONVERTED", "FORMATTED" or "WITH_UNITS".
        """
        if self.count:
            values = [self._read(data, self.start + number * self.bits) for number in range(self.count)]
            return values if value_type in (RAW, CONVERTED) else str(values)
        return self._shown(self._read(data, self.start), value_type)

    def _shown(self, raw: Any, value_type: str) -> Any:
        if value_type == RAW or raw is None:
            return raw
        value = self.converted(raw)
        if value_type == CONVERTED:
            return value
        shown = self.format % value if self.format and not isinstance(value, str) else str(value)
        return f"{shown} {self.units}" if value_type == WITH_UNITS and self.units else shown

    def converted(self, raw: Any) -> Any:
        """Return the name of a state, or the value in engineering units."""
        if self.states:
            return next((name for name, value in self.states.items() if value == raw), raw)
        coefficients = self.polynomial
        if self.segments:
            coefficients = next((each for low, each in self.segments if raw >= low), self.segments[-1][1])
        if not coefficients:
            return raw
        return sum(factor * raw**power for power, factor in enumerate(coefficients))

    def _read(self, data: bytes, start: int) -> Any:
        if self.kind in ("char", "block"):
            first = start // 8
            last = len(data) if self.bits == 0 else first + self.bits // 8
            if first > len(data) or last > len(data):
                return None
            found = bytes(data[first:last])
            return found if self.kind == "block" else found.split(b"\0", 1)[0].decode("utf-8", "replace")
        if start + self.bits > 8 * len(data):
            return None
        first, last = start // 8, -(-(start + self.bits) // 8)
        piece = data[first:last]
        number = int.from_bytes(piece, "big" if self.big_endian or self.bits <= 8 else "little")
        number = (number >> (8 * last - start - self.bits)) & ((1 << self.bits) - 1)
        if self.kind == "f":
            kind, order = ("f", 4) if self.bits == 32 else ("d", 8)
            return struct.unpack(f">{kind}", number.to_bytes(order, "big"))[0]
        if self.kind == "i" and number >> (self.bits - 1):
            number -= 1 << self.bits
        return bool(number) if self.kind == "bool" else number

    def write(self, data: bytearray, value: Any) -> None:
        """Put a value into a packet.

        Raises:
            UsageError: if the value does not fit the item.
        """
        values = list(value) if self.count and isinstance(value, list | tuple) else [value]
        if len(values) > (self.count or 1):
            raise UsageError(f"{self.name} has {self.count} elements, not {len(values)}")
        for number, each in enumerate(values):
            self._write(data, self.start + number * self.bits, each)

    def _write(self, data: bytearray, start: int, value: Any) -> None:
        if self.kind in ("char", "block"):
            self._write_bytes(data, start // 8, value)
            return
        number = self._number(value)
        first, last = start // 8, -(-(start + self.bits) // 8)
        if self.kind == "f":
            number = int.from_bytes(struct.pack(">f" if self.bits == 32 else ">d", number), "big")
        order: Literal["big", "little"] = "big" if self.big_endian or self.bits <= 8 else "little"
        shift = 8 * last - start - self.bits
        mask = ((1 << self.bits) - 1) << shift
        whole = int.from_bytes(data[first:last], order) & ~mask
        whole |= (int(number) << shift) & mask
        data[first:last] = whole.to_bytes(last - first, order)

    def _write_bytes(self, data: bytearray, first: int, value: Any) -> None:
        raw = bytes(value) if isinstance(value, bytes | bytearray) else str(value).encode()
        if self.bits == 0:
            data[first:] = raw
            return
        size = self.bits // 8
        if len(raw) > size:
            raise UsageError(f"{self.name} has {size} bytes, and the value {len(raw)}")
        data[first : first + size] = raw.ljust(size, b"\0")

    def _number(self, value: Any) -> Any:
        if isinstance(value, str):
            if value.upper() not in self.states:
                hint = did_you_mean(value.upper(), list(self.states), "") if self.states else "it has no states"
                raise UsageError(f"{self.name} cannot be {value!r}; {hint}")
            value = self.states[value.upper()]
        if self.kind == "f":
            return float(value)
        if not isinstance(value, int | float) or int(value) != value:
            raise UsageError(f"{self.name} must be a whole number, not {value!r}")
        low = -(1 << (self.bits - 1)) if self.kind == "i" else 0
        high = (1 << (self.bits - (self.kind == "i"))) - 1
        if not low <= value <= high and not -(1 << (self.bits - 1)) <= value < 0:
            raise UsageError(f"{self.name} must be from {low} to {high}, not {value}")
        return int(value)

    def check_range(self, value: Any) -> None:
        """Check that a parameter is in its valid range and, as COSMOS 6 does, one of its states.

        Raises:
            UsageError: if it is not.
        """
        number = self.states.get(value.upper()) if isinstance(value, str) else value
        if not isinstance(number, int | float):
            return
        if self.low is not None and self.high is not None and not self.low <= number <= self.high:
            raise UsageError(f"{self.name} = {number} is not in the valid range of {self.low:g} to {self.high:g}")
        if self.states and number not in self.states.values():
            known = ", ".join(f"{name} {each}" for name, each in self.states.items())
            raise UsageError(f"{self.name} = {number} is not one of the states {known}")


@dataclass(slots=True)
class PacketDefinition:
    """A command or telemetry packet of a target.

    Attributes:
        target, name: in capitals.
        is_command: whether it is a command.
        msg_id: its MsgId.
        code: function code of a command; None without one.
        items: items by name, in order.
        size: bytes of the packet.
        text: description.
        hazardous: why the command is hazardous; None if it is not.
        file, line: where it is defined.
        read_all: decodes a packet whose items are not at fixed bits, such as a ROS message, to values by name.
    """

    target: str
    name: str
    is_command: bool
    msg_id: int
    code: int | None = None
    items: dict[str, Item] = field(default_factory=dict)
    size: int = 0
    text: str = ""
    hazardous: str | None = None
    file: Path | None = None
    line: int = 0
    read_all: Callable[[bytes], Mapping[str, Any]] | None = None
    _squeezed: dict[str, Item] = field(default_factory=dict)

    @property
    def full_name(self) -> str:
        """Target and packet, as in procedures."""
        return f"{self.target} {self.name}"

    def item(self, name: str) -> Item:
        """Return an item; underscores need not be given as they are.

        Raises:
            UsageError: if there is no such item.
        """
        known = self.items.get(name.upper())
        if known is not None:
            return known
        if not self._squeezed:
            self._squeezed = {squeezed(each): item for each, item in self.items.items()}
        found = self._squeezed.get(squeezed(name))
        if found is None:
            hint = did_you_mean(name.upper(), list(self.items), "it has no items")
            raise UsageError(f"{self.full_name} has no item {name.upper()}; {hint}")
        return found

    def built(self, values: Mapping[str, Any], check_range: bool = True, is_raw: bool = False) -> bytes:
        """Return the bytes of a command, without its checksum.

        Args:
            values: values by names of parameters; the others have their defaults.
            check_range: whether parameters must be in their valid ranges, and one of their states.
            is_raw: whether the values are not converted, so names of states are refused.

        Raises:
            UsageError: for an unknown parameter, a missing one, or a value that does not fit.
        """
        data = bytearray(self.size)
        given = {self.item(name).name: value for name, value in values.items()}
        for item in self.items.values():
            if item.name not in given and item.required:
                raise UsageError(f"{self.full_name} requires the parameter {item.name}")
            value = given.get(item.name, item.default)
            try:
                if is_raw and item.name in given and isinstance(value, str) and item.kind not in ("char", "block"):
                    raise UsageError(f"a raw {item.name} must be a number, not {value!r}; use cmd for names of states")
                if check_range and item.name in given:
                    item.check_range(value)
                item.write(data, value)
            except UsageError as error:
                raise UsageError(f"{self.full_name}: {error.text}") from None
        return bytes(data)

    def hazard(self, values: Mapping[str, Any]) -> str | None:
        """Return why the command with these values is hazardous, or None if it is not."""
        if self.hazardous is not None:
            return self.hazardous
        for name, value in values.items():
            states = self.item(name).hazardous
            if isinstance(value, str) and value.upper() in states:
                return states[value.upper()]
        return None


def squeezed(name: str) -> str:
    """Return a name in capitals without underscores and brackets, for comparison."""
    return "".join(each for each in name.upper() if each.isalnum())
