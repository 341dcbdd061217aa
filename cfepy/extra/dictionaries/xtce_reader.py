"""Packets of XTCE documents (OMG, CCSDS 660.1): sequence containers of telemetry, and meta commands.

Containers and commands may be derived from others. The MsgId comes from the values that a packet's header must have:
the restrictions of its containers, or the fixed and assigned values of a command.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator
from dataclasses import dataclass, field

from cfepy.extra.dictionaries.nasa_names import snake
from cfepy.extra.dictionaries.packets import DeclaredPacket, SourceContent
from cfepy.extra.dictionaries.placed_items import header_value, payload_of, plain_or_bits
from cfepy.extra.dictionaries.placed_types import MOST_BITS, MOST_CELLS
from cfepy.extra.dictionaries.xml_tags import XmlTag
from cfepy.msg import FieldPlace, Layout, Measurement, ValueNames
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError

ROOT = "SpaceSystem"
_LITTLE = "leastSignificantByteFirst"
_CODE_START, _CODE_BITS, _COMMAND_BITS, _CODE_MASK = 48, 8, 0x1800, 0x7F
_MID_BITS = 16
_DEEP = 40  # containers and types inside each other
_ENCODINGS = ("IntegerDataEncoding", "FloatDataEncoding", "StringDataEncoding", "BinaryDataEncoding")
_SIGNS = {"unsigned": "u", "twosComplement": "i"}


@dataclass(slots=True)
class _Kind:
    """The type of a parameter or an argument: its bits, of which `kind` is "u", "i", "f", "bool", "char" or "block"."""

    kind: str
    bits: int
    big_endian: bool = True
    names: dict[str, int] = field(default_factory=dict)
    measurement: Measurement | None = None
    members: tuple[tuple[str, _Kind], ...] = ()
    count: int = 0

    @property
    def width(self) -> int:
        """The bits of the whole value."""
        if self.kind == "struct":
            return sum(kind.width for _, kind in self.members)
        return self.bits * (self.count or 1)

    def places(self, steps: tuple[str | int, ...], start: int) -> Iterator[FieldPlace]:
        """Yield the places of its numbers and texts."""
        if self.kind == "block":
            for number in range(self.bits // 8):
                yield FieldPlace((*steps, number), "u", start + 8 * number, 8)
        elif self.kind == "array":
            item = self.members[0][1]
            for number in range(self.count):
                yield from item.places((*steps, number), start + number * item.width)
        elif self.members:
            for name, kind in self.members:
                yield from kind.places((*steps, name), start)
                start += kind.width
        else:
            names = ValueNames.of(f"{self.kind}{self.bits}", self.names) if self.names else None
            yield FieldPlace(steps, self.kind, start, self.bits, self.big_endian, names, self.measurement)


@dataclass(slots=True)
class _Entries:
    """The entries of a packet so far, `end` is the bit after the last one; `values` are those that they must have."""

    places: list[FieldPlace] = field(default_factory=list)
    lines: dict[str, int] = field(default_factory=dict)
    end: int = 0
    values: dict[str, int] = field(default_factory=dict)
    fixed: list[tuple[FieldPlace, int]] = field(default_factory=list)


def read_xtce(roots: Iterable[XmlTag]) -> SourceContent:
    """Return the packets of documents."""
    content = SourceContent("XTCE")
    structs: dict[str, Layout] = {}
    for root in roots:
        _read_system(root, content, structs)
    content.layout = structs.get
    return content


def _read_system(system: XmlTag, content: SourceContent, structs: dict[str, Layout]) -> None:
    _System(system, content, structs).read()
    for inner in system.all(ROOT):
        _read_system(inner, content, structs)


class _System:
    """A space system: its types, parameters and containers by name."""

    def __init__(self, tag: XmlTag, content: SourceContent, structs: dict[str, Layout]) -> None:
        self._content = content
        self._structs = structs
        telemetry, commands = tag.first("TelemetryMetaData"), tag.first("CommandMetaData")
        self._parts = [part for part in (telemetry, commands) if part is not None]
        self._types = {
            each.attributes.get("name", ""): each
            for part in self._parts
            for each in (*_in(part, "ParameterTypeSet"), *_in(part, "ArgumentTypeSet"))
        }
        self._parameters = {
            each.attributes.get("name", ""): each for part in self._parts for each in _in(part, "ParameterSet")
        }
        self._containers = [each for part in self._parts for each in _in(part, "ContainerSet")]
        self._containers += [] if commands is None else _in(commands, "CommandContainerSet")
        self._by_name = {each.attributes.get("name", ""): each for each in self._containers}
        self._commands = [] if commands is None else _in(commands, "MetaCommandSet")
        self._commands_by_name = {each.attributes.get("name", ""): each for each in self._commands}

    def read(self) -> None:
        """Add the packets."""
        for container in self._containers:
            if container.attributes.get("abstract") != "true":
                self._attempt(container, self._add_telemetry)
        for command in self._commands:
            if command.name == "MetaCommand" and command.attributes.get("abstract") != "true":
                self._attempt(command, self._add_command)

    def _attempt(self, tag: XmlTag, add: Callable[[XmlTag], None]) -> None:
        try:
            add(tag)
        except UsageError as error:
            self._content.add_problem(error, tag.file)

    def _add_telemetry(self, container: XmlTag) -> None:
        entries = _Entries()
        self._walk(container, entries, {}, 0)
        if container.first("BaseContainer") is None:  # no packet, but perhaps the row of a table
            name = container.need("name")
            self._structs.setdefault(name, plain_or_bits(name, entries.places, -(-entries.end // 8)))
            return
        msg_id = self._msg_id(container, entries)
        if msg_id & 0x1000:
            return  # the container of a command
        self._add(container, entries, msg_id, None, is_command=False)

    def _add_command(self, command: XmlTag) -> None:
        entries = _Entries()
        arguments: dict[str, XmlTag] = {}
        self._walk_command(command, entries, arguments, 0)
        msg_id = self._msg_id(command, entries)
        known = self._known(entries)
        has_code = any(place.start <= _CODE_START < place.start + place.bits for place, _ in known)
        code = header_value(known, _CODE_START, _CODE_BITS) & _CODE_MASK if has_code else None
        self._add(command, entries, msg_id, code, is_command=True)

    def _add(self, tag: XmlTag, entries: _Entries, msg_id: int, code: int | None, is_command: bool) -> None:
        name = snake(tag.need("name"))
        text = tag.attributes.get("shortDescription", "")
        prefix = f"{tag.need('name')}_"
        inner = [place._replace(steps=_short(place.steps, prefix)) for place in entries.places]
        payload = payload_of(name, inner, entries.end, is_command)
        lines = {name.removeprefix(prefix): line for name, line in entries.lines.items()}
        self._content.packets.append(
            DeclaredPacket(name, msg_id, payload, is_command, tag.file, tag.line, code, text, None, lines)
        )

    def _known(self, entries: _Entries) -> list[tuple[FieldPlace, int]]:
        """Return the places of header fields with the values that they must have."""
        found = [(place, entries.values[place.path]) for place in entries.places if place.path in entries.values]
        return [*entries.fixed, *found]

    def _msg_id(self, tag: XmlTag, entries: _Entries) -> int:
        msg_id = header_value(self._known(entries), 0, _MID_BITS)
        if msg_id == 0:
            raise tag.fail("its MsgId is not known; add restrictions or fixed values for its primary header")
        return msg_id

    # -- entries -------------------------------------------------------------------------------------------------------

    def _walk(self, container: XmlTag, entries: _Entries, arguments: dict[str, XmlTag], depth: int) -> None:
        """Add the entries of the base of a container, then its own."""
        if depth > _DEEP:
            raise container.fail(f"is derived from itself, or more than {_DEEP} containers deep; correct its base")
        base = container.first("BaseContainer")
        if base is not None:
            self._walk(self._container(base, "containerRef"), entries, arguments, depth + 1)
            for each in _comparisons(base):
                entries.values[_last(each.need("parameterRef"))] = _number(each, each.need("value"))
        first = entries.end
        for each in (entry for part in container.all("EntryList") for entry in part.tags):
            self._entry(each, entries, arguments, first, depth)
            if len(entries.places) > MOST_CELLS or entries.end > MOST_BITS:
                raise each.fail(f"the packet is larger than {MOST_BITS // 8:,} bytes or {MOST_CELLS:,} values")

    def _walk_command(self, command: XmlTag, entries: _Entries, arguments: dict[str, XmlTag], depth: int) -> None:
        if depth > _DEEP:
            raise command.fail(f"is derived from itself, or more than {_DEEP} commands deep; correct its base")
        base = command.first("BaseMetaCommand")
        if base is not None:
            name = _last(base.need("metaCommandRef"))
            if name not in self._commands_by_name:
                hint = did_you_mean(name, self._commands_by_name, "add it, or correct the name")
                raise base.fail(f"unknown command {name}; {hint}")
            self._walk_command(self._commands_by_name[name], entries, arguments, depth + 1)
            for each in base.inside("ArgumentAssignmentList", "ArgumentAssignment"):
                entries.values[each.need("argumentName")] = _number(each, each.need("argumentValue"))
        for each in command.inside("ArgumentList", "Argument"):
            arguments[each.need("name")] = each
        container = command.first("CommandContainer")
        if container is None:
            return
        own = container.first("BaseContainer")
        if own is not None and not entries.places and not entries.fixed:
            self._walk(self._container(own, "containerRef"), entries, arguments, depth + 1)
            for each in _comparisons(own):
                entries.values[_last(each.need("parameterRef"))] = _number(each, each.need("value"))
        first = entries.end
        for each in (entry for part in container.all("EntryList") for entry in part.tags):
            self._entry(each, entries, arguments, first, depth)

    def _entry(self, tag: XmlTag, entries: _Entries, arguments: dict[str, XmlTag], first: int, depth: int) -> None:
        start = self._start(tag, entries, first)
        if tag.name == "ContainerRefEntry":
            inner = self._container(tag, "containerRef")
            entries.end = start
            self._walk(inner, entries, arguments, depth + 1)
        elif tag.name == "FixedValueEntry":
            bits = _number(tag, tag.need("sizeInBits"))
            if not 1 <= bits <= MOST_BITS:
                raise tag.fail(f"sizeInBits must be from 1 to {MOST_BITS:,}, not {bits}")
            value = _hex(tag)
            entries.fixed.append((FieldPlace((tag.attributes.get("name", ""),), "u", start, bits), value))
            entries.end = max(entries.end, start + bits)
        elif tag.name in ("ParameterRefEntry", "ArgumentRefEntry"):
            self._value(tag, entries, arguments, start)
        elif tag.name not in ("LongDescription", "AncillaryDataSet"):
            raise tag.fail("entries of this kind are not supported; use parameters, arguments and containers")

    def _value(self, tag: XmlTag, entries: _Entries, arguments: dict[str, XmlTag], start: int) -> None:
        is_argument = tag.name == "ArgumentRefEntry"
        name = _last(tag.need("argumentRef" if is_argument else "parameterRef"))
        known = arguments if is_argument else self._parameters
        if name not in known:
            raise tag.fail(f"unknown name {name}; {did_you_mean(name, known, 'declare it, or correct the name')}")
        kind = self._kind(
            known[name], _last(known[name].need("argumentTypeRef" if is_argument else "parameterTypeRef"))
        )
        if not name.startswith("padding"):
            entries.places += kind.places((name,), start)
            entries.lines[name] = known[name].line
        entries.end = max(entries.end, start + kind.width)

    def _start(self, tag: XmlTag, entries: _Entries, first: int) -> int:
        place = tag.first("LocationInContainerInBits")
        if place is None:
            return entries.end
        offset = place.first("FixedValue")
        if offset is None:
            raise place.fail("a place that depends on other values is not supported; give a <FixedValue>")
        rule = place.attributes.get("referenceLocation", "previousEntry")
        if rule not in ("previousEntry", "containerStart"):
            raise place.fail(f"places from {rule} are not supported; count from containerStart or previousEntry")
        start = (first if rule == "containerStart" else entries.end) + _number(offset, offset.text.strip())
        if start < 0:
            raise place.fail("must not be before the start of the packet")
        return start

    def _container(self, tag: XmlTag, attribute: str) -> XmlTag:
        name = _last(tag.need(attribute))
        if name not in self._by_name:
            raise tag.fail(f"unknown container {name}; {did_you_mean(name, self._by_name, 'correct the name')}")
        return self._by_name[name]

    # -- types ---------------------------------------------------------------------------------------------------------

    def _kind(self, user: XmlTag, name: str, depth: int = 0) -> _Kind:
        if name not in self._types:
            raise user.fail(
                f"unknown type {name}; {did_you_mean(name, self._types, 'declare it, or correct the name')}"
            )
        if depth > _DEEP:
            raise user.fail(f"the type {name} contains itself; correct it")
        tag = self._types[name]
        what = tag.name.removesuffix("ParameterType").removesuffix("ArgumentType")
        if what == "Aggregate":
            members = tuple(
                (each.need("name"), self._kind(each, _last(each.need("typeRef")), depth + 1))
                for each in tag.inside("MemberList", "Member")
            )
            return _Kind("struct", 0, members=members)
        if what == "Array":
            return self._array(tag, depth)
        encoding = next(iter([*tag.all(*_ENCODINGS), *_encoding_of_time(tag)]), None)
        if encoding is None:
            raise tag.fail("has no data encoding; add one, such as <IntegerDataEncoding>")
        kind = _encoded(encoding)
        if what == "Boolean" and kind.kind in "ui":
            return _Kind("bool", kind.bits, kind.big_endian)
        if what == "Enumerated":
            if kind.kind not in ("u", "i"):
                raise tag.fail("an enumeration requires an <IntegerDataEncoding>")
            kind.names = {
                each.need("label"): _number(each, each.need("value"))
                for each in tag.inside("EnumerationList", "Enumeration")
            }
        elif what in ("Integer", "Float") and kind.kind in "uif" and kind.bits in (8, 16, 32, 64):
            kind.measurement = _measurement(tag, encoding, f"{kind.kind}{kind.bits}")
        return kind

    def _array(self, tag: XmlTag, depth: int) -> _Kind:
        item = self._kind(tag, _last(tag.need("arrayTypeRef")), depth + 1)
        count = 1
        for each in tag.inside("DimensionList", "Dimension"):
            ends = [each.first(end, "FixedValue") for end in ("StartingIndex", "EndingIndex")]
            if None in ends:
                raise each.fail("must have a StartingIndex and an EndingIndex with a <FixedValue>")
            low, high = (_number(end, end.text.strip()) for end in ends if end is not None)
            count *= high - low + 1
        if not 1 <= count <= MOST_CELLS or count * item.width > MOST_BITS:
            raise tag.fail(f"an array of {count} items is not possible; correct its dimensions")
        return _Kind("array", item.width, members=(("", item),), count=count)


def _in(part: XmlTag, name: str) -> list[XmlTag]:
    return [each for found in part.all(name) for each in found.tags]


def _encoding_of_time(tag: XmlTag) -> list[XmlTag]:
    """Return the encoding of a time, which is one tag deeper."""
    return [each for found in tag.all("Encoding") for each in found.all(*_ENCODINGS)]


def _encoded(encoding: XmlTag) -> _Kind:
    if encoding.name in ("StringDataEncoding", "BinaryDataEncoding"):
        size = encoding.first("SizeInBits", "Fixed", "FixedValue") or encoding.first("SizeInBits", "FixedValue")
        if size is None:
            raise encoding.fail("a variable size is not supported; give a <FixedValue>")
        bits = _number(size, size.text.strip())
        if bits < 8 or bits % 8 or bits > MOST_BITS:
            raise encoding.fail(f"must have whole bytes, not {bits} bits")
        return _Kind("char" if encoding.name == "StringDataEncoding" else "block", bits)
    default = "32" if encoding.name == "FloatDataEncoding" else "8"
    bits = _number(encoding, encoding.attributes.get("sizeInBits", default))
    if not 1 <= bits <= 64 or (encoding.name == "FloatDataEncoding" and bits < 32):
        raise encoding.fail(f"a number of {bits} bits is not supported; expected 1 to 64, or 32 and 64 for a float")
    big_endian = encoding.attributes.get("byteOrder", "") != _LITTLE
    if encoding.name == "FloatDataEncoding":
        return _Kind("f", bits, big_endian)
    rule = encoding.attributes.get("encoding", "unsigned")
    if rule not in _SIGNS:
        raise encoding.fail(f"the encoding {rule!r} is not supported; expected {' or '.join(_SIGNS)}")
    if not big_endian and bits % 8:
        raise encoding.fail(f"a number of {bits} bits cannot have its lowest byte first")
    return _Kind(_SIGNS[rule], bits, big_endian)


def _measurement(tag: XmlTag, encoding: XmlTag, word: str) -> Measurement | None:
    """Return unit, calibration and limits of a type, or None if it has none."""
    unit = next((each.text.strip() for each in tag.inside("UnitSet", "Unit")), "")
    terms = list(encoding.inside("DefaultCalibrator", "PolynomialCalibrator", "Term"))
    exponents = [_number(each, each.need("exponent")) for each in terms]
    degree = max(exponents, default=-1)
    if degree > 20 or min(exponents, default=0) < 0:
        raise encoding.fail("the exponents of a polynomial must be from 0 to 20")
    polynomial = [0.0] * (degree + 1)
    for each in terms:
        polynomial[_number(each, each.need("exponent"))] = _float(each, "coefficient")
    points = tuple(
        (_float(each, "raw"), _float(each, "calibrated"))
        for each in encoding.inside("DefaultCalibrator", "SplineCalibrator", "SplinePoint")
    )
    limits = {}
    for name in ("WarningRange", "CriticalRange"):
        found = tag.first("DefaultAlarm", "StaticAlarmRanges", name)
        limits[name] = None if found is None else (_limit(found, "minInclusive"), _limit(found, "maxInclusive"))
    if not (unit or polynomial or points or any(limits.values())):
        return None
    return Measurement(word, unit, tuple(polynomial), points, limits["WarningRange"], limits["CriticalRange"])


def _limit(tag: XmlTag, name: str) -> float | None:
    return _float(tag, name) if name in tag.attributes else None


def _float(tag: XmlTag, name: str) -> float:
    text = tag.need(name)
    try:
        return float(text)
    except ValueError:
        raise tag.fail(f"{name} must be a number, not {text!r}") from None


def _comparisons(base: XmlTag) -> Iterator[XmlTag]:
    yield from base.inside("RestrictionCriteria", "Comparison")
    yield from base.inside("RestrictionCriteria", "ComparisonList", "Comparison")


def _number(tag: XmlTag, text: str) -> int:
    try:
        return int(text, 0)
    except ValueError:
        raise tag.fail(f"must be a whole number, not {text!r}") from None


def _hex(tag: XmlTag) -> int:
    text = tag.need("binaryValue")
    try:
        return int(text, 16)
    except ValueError:
        raise tag.fail(f"binaryValue must be hexadecimal digits, not {text!r}") from None


def _last(reference: str) -> str:
    """Return the name of a reference such as "../Types/u8"."""
    return reference.rpartition("/")[2]


def _short(steps: tuple[str | int, ...], prefix: str) -> tuple[str | int, ...]:
    """Return steps without the name of the packet in front of the field's."""
    first = steps[0]
    return (first.removeprefix(prefix) or first, *steps[1:]) if isinstance(first, str) else steps
