"""Packets of command and telemetry text of COSMOS and OpenC3 (`cmd_tlm/*.txt`).

A file has lines such as `COMMAND HS NOOP LITTLE_ENDIAN "No operation"`, and below each the items of the whole packet,
header included. Text between `<%` and `%>` is a program in Ruby: it is not executed, so write its output.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from dataclasses import dataclass, field
from pathlib import Path

from cfepy.extra.dictionaries.nasa_names import snake
from cfepy.extra.dictionaries.packets import DeclaredPacket, DeclaredTable, SourceContent
from cfepy.extra.dictionaries.placed_items import header_value, payload_of, plain_or_bits
from cfepy.extra.dictionaries.placed_types import MOST_BITS, MOST_CELLS
from cfepy.msg import FieldPlace, Measurement, ValueNames
from cfepy.reading.cosmos_lines import DERIVED, item_forms, kind_of_item, next_word, whole_number, words_of
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import LINE_FILE_BYTES
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError

_ORDERS = {"BIG_ENDIAN": True, "LITTLE_ENDIAN": False}
_IGNORED = (
    *("FORMAT_STRING", "META", "HAZARDOUS", "HIDDEN", "DISABLED", "ALLOW_SHORT", "ACCESSOR", "TEMPLATE", "OVERFLOW"),
    *("REQUIRED", "KEY", "VALIDATOR", "RESPONSE", "SCREEN", "RELATED_ITEM", "VIRTUAL", "RESTRICTED", "SUBPACKET"),
    *("LIMITS_RESPONSE", "READ_CONVERSION", "WRITE_CONVERSION", "GENERIC_READ_CONVERSION_START", "OVERLAP", "VARIABLE"),
    *("DISABLE_MESSAGES", "PROCESSOR", "IGNORE_OVERLAP", "POLY_WRITE_CONVERSION", "SEG_POLY_WRITE_CONVERSION"),
    *(
        "MINIMUM_VALUE",
        "SEG_POLY_READ_CONVERSION",
        "MAXIMUM_VALUE",
        "DEFAULT_VALUE",
        "OBFUSCATE",
        "ERROR_RESPONSE",
        "CATALOG",
        "SUBPACKETIZER",
    ),
    *("LIMITS_GROUP", "LIMITS_GROUP_ITEM", "LANGUAGE", "SELECT_TARGET"),
)
_BIT_KINDS = ("u", "i", "bool")
PADDING = "PADDING_AT_THE_END"
"""The item that makes a packet as long as its struct."""
_MID_BITS, _CODE_START, _CODE_BITS, _HAS_CODE = 16, 48, 8, 0x1800


@dataclass(slots=True)
class _Item:
    """An item of a packet under construction."""

    name: str
    kind: str
    start: int
    bits: int
    count: int
    big_endian: bool
    line: int
    value: int | None = None
    is_id: bool = False
    names: dict[str, int] = field(default_factory=dict)
    unit: str = ""
    polynomial: tuple[float, ...] = ()
    limits: tuple[float, float, float, float] | None = None

    def places(self) -> Iterator[FieldPlace]:
        """Yield the places of its values."""
        if self.kind == "block":
            for number in range(self.bits // 8):
                yield FieldPlace((self.name, number), "u", self.start + 8 * number, 8)
            return
        names = ValueNames.of(f"{self.kind}{self.bits}", self.names) if self.names else None
        for number in range(self.count or 1):
            steps = (self.name, number) if self.count else (self.name,)
            start = self.start + number * self.bits
            yield FieldPlace(steps, self.kind, start, self.bits, self.big_endian, names, self._measurement())

    def _measurement(self) -> Measurement | None:
        known = self.unit or self.polynomial or self.limits
        if not known or self.names or self.kind not in "uif" or self.bits not in (8, 16, 32, 64):
            return None
        red_low, yellow_low, yellow_high, red_high = self.limits or (None, None, None, None)
        return Measurement(
            f"{self.kind}{self.bits}",
            self.unit,
            self.polynomial,
            (),
            None if self.limits is None else (yellow_low, yellow_high),
            None if self.limits is None else (red_low, red_high),
        )


@dataclass(slots=True)
class _Packet:
    """A packet or a table under construction: `end` is the bit after its last item, `rows` are the rows of a table."""

    target: str
    name: str
    is_command: bool
    big_endian: bool
    text: str
    line: int
    items: list[_Item] = field(default_factory=list)
    end: int = 0
    rows: int = 0


def read_cosmos(files: Iterable[Path]) -> SourceContent:
    """Return the packets of files; a file with an error keeps those before and after it."""
    content = SourceContent("COSMOS")
    for file in files:
        try:
            text = read_limited(file, LINE_FILE_BYTES).decode("utf-8", "replace")
        except (UsageError, OSError) as error:
            unread = error if isinstance(error, UsageError) else UsageError(f"cannot be read: {error.strerror}")
            content.add_problem(unread, file)
            continue
        _Reader(file, content).read(text)
    return content


def is_cosmos(text: str) -> bool:
    """Return whether a text has commands or telemetry of COSMOS."""
    return re.search(r"^\s*(COMMAND|TELEMETRY|TABLE)\s+\S+\s+\S+", text, re.MULTILINE) is not None


class _Reader:
    def __init__(self, file: Path, content: SourceContent) -> None:
        self._file = file
        self._content = content
        self._packet: _Packet | None = None
        self._skips = False
        self._generic = False

    def read(self, text: str) -> None:
        """Read all lines of the file."""
        for line, written in enumerate(text.splitlines(), 1):
            try:
                self._take(line, written)
            except UsageError as error:
                self._skips = error.field != "item"
                located = UsageError(error.text, file=self._file, line=line)
                self._content.add_problem(located, self._file)
        self._finish()

    def _take(self, line: int, written: str) -> None:
        if "<%" in written:
            raise UsageError("Ruby between <% and %> is not executed; write the lines that it prints")
        words = words_of(written)
        if not words:
            return
        keyword = words[0].upper()
        if keyword in ("GENERIC_READ_CONVERSION_END", "GENERIC_WRITE_CONVERSION_END"):
            self._generic = False
        elif self._generic:
            return
        elif keyword in ("GENERIC_READ_CONVERSION_START", "GENERIC_WRITE_CONVERSION_START"):
            self._generic = True
        elif keyword in ("COMMAND", "TELEMETRY", "TABLE"):
            self._finish()
            self._packet = _begun_table(words, line) if keyword == "TABLE" else _begun(keyword, words, line)
            self._skips = False
        elif keyword in ("SELECT_COMMAND", "SELECT_TELEMETRY"):
            self._finish()
            self._skips = True
        elif self._packet is not None and not self._skips:
            self._inside(self._packet, keyword, words, line)

    def _inside(self, packet: _Packet, keyword: str, words: list[str], line: int) -> None:
        forms = item_forms(keyword)
        if forms is not None:
            packet.items.append(_item(packet, forms, words, line))
            if len(packet.items) > MOST_CELLS:
                raise UsageError(f"the packet has more than {MOST_CELLS:,} items; split it")
        elif keyword in _DETAILS:
            if not packet.items:
                raise UsageError(f"{keyword} requires an item above it; add one")
            _DETAILS[keyword](packet.items[-1], words)
        elif keyword not in _IGNORED:
            hint = did_you_mean(keyword, [*_DETAILS, "APPEND_ITEM", "APPEND_PARAMETER"], "remove it")
            raise UsageError(f"unknown keyword {keyword}; {hint}", field="item")

    def _finish(self) -> None:
        """Add the packet that ends here."""
        packet, self._packet = self._packet, None
        if packet is None or self._skips:
            return
        try:
            if packet.rows:
                self._content.tables.append(_declared_table(packet, self._file))
            else:
                self._content.packets.append(_declared(packet, self._file))
        except UsageError as error:
            self._content.add_problem(UsageError(error.text, file=self._file, line=packet.line), self._file)


def _begun(keyword: str, words: list[str], line: int) -> _Packet:
    if len(words) < 4 or words[3].upper() not in _ORDERS:
        raise UsageError(f"{keyword} requires a target, a name, and BIG_ENDIAN or LITTLE_ENDIAN")
    text = words[4] if len(words) > 4 else ""
    return _Packet(words[1], words[2], keyword == "COMMAND", _ORDERS[words[3].upper()], text, line)


def _begun_table(words: list[str], line: int) -> _Packet:
    """Return a table from its line: `TABLE APP.Name LITTLE_ENDIAN ROW_COLUMN 4 "Text"`, or KEY_VALUE without rows."""
    kind = words[3].upper() if len(words) > 3 else ""
    if kind not in ("KEY_VALUE", "ROW_COLUMN") or words[2].upper() not in _ORDERS:
        raise UsageError("TABLE requires a name, BIG_ENDIAN or LITTLE_ENDIAN, and KEY_VALUE or ROW_COLUMN with rows")
    rest = words[4:]
    rows = whole_number(next_word(rest, "the number of rows")) if kind == "ROW_COLUMN" else 1
    if not 1 <= rows <= MOST_CELLS:
        raise UsageError(f"a table has 1 to {MOST_CELLS:,} rows, not {rows}")
    text = rest[0] if rest else ""
    return _Packet("", words[1], True, _ORDERS[words[2].upper()], text, line, rows=rows)


def _item(packet: _Packet, kinds: set[str], words: list[str], line: int) -> _Item:
    """Return an item from its line, and move the end of the packet."""
    rest = words[1:]
    name = next_word(rest, "a name")
    start = packet.end if "APPEND" in kinds else whole_number(next_word(rest, "a bit offset"))
    bits = whole_number(next_word(rest, "a number of bits"))
    kind = kind_of_item(rest)
    if kind == DERIVED:
        return _Item(name, "derived", 0, 0, 0, True, line)
    count = 0
    if "ARRAY" in kinds:
        whole = whole_number(next_word(rest, "the bits of the array"))
        count = whole // bits if bits > 0 else 0
        if count < 1:
            raise UsageError(f"an array of {whole} bits cannot have items of {bits} bits; correct the numbers")
    item = _Item(name, kind, start, bits, count, packet.big_endian, line, is_id="ID" in kinds)
    _check_size(item)
    if "ARRAY" not in kinds:
        item.value = _value(item, packet.is_command, rest)
    rest = rest[1:]  # the description
    item.big_endian = _ORDERS.get(rest[0].upper(), item.big_endian) if rest else item.big_endian
    _check_order(item)
    packet.end = max(packet.end, item.start + item.bits * (item.count or 1))
    if packet.end > MOST_BITS:
        raise UsageError(f"the packet is larger than {MOST_BITS // 8:,} bytes; correct the numbers of bits")
    return item


def _value(item: _Item, is_command: bool, rest: list[str]) -> int | None:
    """Return the value that a parameter or an ID item always has, or has unless the user gives another one."""
    if not is_command:
        return whole_number(next_word(rest, "the value of the ID")) if item.is_id else None
    if item.kind in ("char", "block"):
        next_word(rest, "a default value")
        return None
    next_word(rest, "a lowest value")
    next_word(rest, "a highest value")
    value = next_word(rest, "a default value")
    try:
        return whole_number(value)
    except UsageError:
        return None  # a floating-point number, or a name of a state


def _check_size(item: _Item) -> None:
    if item.start < 0 or item.bits < 0:
        raise UsageError("a place or size from the end of the packet is not supported; give it from the start")
    if item.bits == 0:
        raise UsageError("an item of variable size is not supported; give its number of bits")
    sizes = {"f": (32, 64)}.get(item.kind)
    if sizes is not None and item.bits not in sizes:
        raise UsageError(f"a FLOAT has 32 or 64 bits, not {item.bits}")
    if item.kind in _BIT_KINDS and item.bits > 64:
        raise UsageError(f"a number has at most 64 bits, not {item.bits}; use an array or a BLOCK")
    if item.kind in ("char", "block") and item.bits % 8:
        raise UsageError(f"a STRING or BLOCK has whole bytes, not {item.bits} bits")
    if item.kind == "char" and item.start % 8:
        raise UsageError("a STRING starts at a whole byte; correct its bit offset")


def _check_order(item: _Item) -> None:
    within_a_byte = item.start % 8 + item.bits <= 8
    if item.kind in _BIT_KINDS and not item.big_endian and not within_a_byte and (item.bits % 8 or item.start % 8):
        raise UsageError("a LITTLE_ENDIAN number that is not whole bytes is not supported; make it BIG_ENDIAN")


def _number(word: str) -> float:
    try:
        return float(word)
    except ValueError:
        raise UsageError(f"must be a number, not {word!r}") from None


# -- details of an item ------------------------------------------------------------------------------------------------


def _state(item: _Item, words: list[str]) -> None:
    if len(words) < 3:
        raise UsageError("STATE requires a name and a value")
    if item.kind not in ("u", "i"):
        raise UsageError("STATE requires a UINT or an INT")
    if words[2].upper() != "ANY":
        item.names[words[1]] = whole_number(words[2])


def _units(item: _Item, words: list[str]) -> None:
    item.unit = words[-1] if len(words) > 1 else ""


def _polynomial(item: _Item, words: list[str]) -> None:
    item.polynomial = tuple(map(_number, words[1:]))


def _limits(item: _Item, words: list[str]) -> None:
    if len(words) >= 8 and words[1].upper() == "DEFAULT":
        red_low, yellow_low, yellow_high, red_high = map(_number, words[4:8])
        item.limits = red_low, yellow_low, yellow_high, red_high


_DETAILS = {
    "STATE": _state,
    "UNITS": _units,
    "POLY_READ_CONVERSION": _polynomial,
    "LIMITS": _limits,
}


def _items_of(packet: _Packet) -> list[_Item]:
    """Return the items of a packet.

    Raises:
        UsageError: if two have the same name.
    """
    items = [each for each in packet.items if each.kind != "derived"]
    names: set[str] = set()
    for each in items:
        if each.name in names:
            raise UsageError(f"{packet.name}: the item {each.name} is declared twice; rename one of them")
        names.add(each.name)
    return items


def _declared_table(table: _Packet, file: Path) -> DeclaredTable:
    items = _items_of(table)
    places = [place for each in items for place in each.places()]
    row = plain_or_bits(table.name, places, -(-table.end // 8))
    lines = {each.name: each.line for each in items}
    return DeclaredTable(table.name, row, table.rows, file, table.line, table.text, lines)


def _declared(packet: _Packet, file: Path) -> DeclaredPacket:
    items = _items_of(packet)
    ids = [(next(each.places()), each.value) for each in items if each.value is not None and each.kind in "ui"]
    known = [(place, value) for place, value in ids if value is not None]
    msg_id = header_value(known, 0, _MID_BITS)
    if msg_id == 0 or not any(each.is_id for each in items):
        remedy = "add an ID item with the first 16 bits of its header"
        raise UsageError(f"{packet.name} has no MsgId; {remedy}")
    code = None
    if packet.is_command and msg_id & _HAS_CODE == _HAS_CODE:
        at_code = [(place, value) for place, value in known if place.start < _CODE_START + _CODE_BITS]
        has_code = any(place.start + place.bits > _CODE_START for place, _ in at_code)
        code = header_value(at_code, _CODE_START, _CODE_BITS) & 0x7F if has_code else None
    places = [place for each in items if each.name != PADDING for place in each.places()]
    name = f"{snake(packet.target)}_{snake(packet.name)}"
    payload = payload_of(name, places, packet.end, packet.is_command)
    lines = {each.name: each.line for each in items}
    return DeclaredPacket(name, msg_id, payload, packet.is_command, file, packet.line, code, packet.text, None, lines)
