"""A mission's packets in XTCE 1.2 (OMG, CCSDS 660.1-G-2), the XML format in which ground systems learn packet layouts.

There is a container for each telemetry packet, derived from those for the CCSDS primary header and cFE's telemetry
header, distinguished by APID; and a MetaCommand for each command, with its header as fixed values and its payload as
arguments. Sequence count and checksum of a command are zero: the sender may set them; unmodified cFE checks neither.
Nested structs and arrays are flattened, padding is given as binary parameters. C's numbers are little-endian, as in the
flight software. Names are the dictionary's, with "_" for characters that XTCE forbids: CFE_EVS_HK_TLM_AppData_0_AppID.

In ROS messages, numbers, texts with their length and arrays of numbers (as bytes) can be described, but not arrays of
texts or messages: the data after them is described as bytes if its place in the packet is fixed, and otherwise left
out.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable, Iterator
from typing import Any, NamedTuple
from xml.etree.ElementTree import Element, SubElement, indent, tostring

from cfepy import __version__
from cfepy.ground.dictionary import Dictionary
from cfepy.ground.topics import Topic, library_of
from cfepy.mission import UNIX_AT_CFE_EPOCH
from cfepy.msg import RED, TLM_HEADER_SIZE, YELLOW, Cell, Command, Layout, Measurement, Telemetry, ValueNames
from cfepy.writing.markup import printable

LITTLE = "leastSignificantByteFirst"
UTF_8_NUL = "00"
MAX_TEXT_BITS = 8 * 32768
NAMESPACE = "http://www.omg.org/spec/XTCE/20180204"
SCHEMA = f"{NAMESPACE} {NAMESPACE}/SpaceSystem.xsd"
ROOT, TELEMETRY = "CCSDSPacket", "CCSDSTelemetry"
APID_MASK = 0x7FF
COMMAND_BIT, SECONDARY_HEADER_BIT = 0x1000, 0x0800  # of a MsgId
WHOLE = "3"  # sequence flags of an unsegmented packet
PRIMARY_HEADER = (
    ("VERSION", 3),
    ("TYPE", 1),
    ("SEC_HDR_FLG", 1),
    ("PKT_APID", 11),
    ("SEQ_FLGS", 2),
    ("SRC_SEQ_CTR", 14),
    ("PKT_LEN", 16),
)
"""Names expected by CCSDS tools in Python, and sizes in bits."""
NUMBERS = {
    "bool": "bool", "char": "u8", "byte": "i8", "int8": "i8", "uint8": "u8", "int16": "i16", "uint16": "u16",
    "int32": "i32", "uint32": "u32", "int64": "i64", "uint64": "u64", "float32": "f32", "float64": "f64",
}  # fmt: skip
"""ROS type to C type."""
TIMES = {"time": ("u32", "u32"), "duration": ("i32", "i32")}
BITS = {"bool": 8}

LENGTH_OFFSET = 7  # PKT_LEN is the size of a packet minus this
UNSEGMENTED = 0xC000


def xtce_name(path: str) -> str:
    """Return a name without characters that XTCE forbids: "/arm_health/samples" becomes arm_health_samples, "Counts[3]"
    Counts_3.
    """
    return re.sub(r"[./:\[\]\s\\]+", "_", printable(path)).strip("_")


def cells_with_padding(layout: Layout) -> Iterator[Cell]:
    """Yield the cells of a layout, and one of type "padding" for every gap."""
    at = 0
    for cell in layout.cells():
        yield from _gap(at, cell.start)
        yield cell
        at = cell.start + cell.width
    yield from _gap(at, 8 * layout.size)


def _gap(at: int, end: int) -> Iterator[Cell]:
    if end > at:
        offset, bit = divmod(at, 8)
        yield Cell("", "padding", offset, -(-end // 8) - offset, bit=bit, bits=end - at)


def add(parent: Element, tag: str, **attributes: str) -> Element:
    """Return a new child element; attributes with value "" are left out."""
    return SubElement(parent, tag, {name: printable(value) for name, value in attributes.items() if value})


class TypeSet:
    """A ParameterTypeSet or an ArgumentTypeSet.

    Args:
        parent: parent element of the set.
        what: "Parameter" or "Argument".
    """

    def __init__(self, parent: Element, what: str) -> None:
        self._what = what
        self._set = add(parent, f"{what}TypeSet")
        self._known: set[str] = set()
        self._measured: dict[tuple[Measurement, bool], int] = {}

    def number(self, kind: str, big_endian: bool = False) -> str:
        """Add a number or bool in C's representation, such as "u16", "i8", "f64"; returns the name of the type.

        Args:
            kind: its kind.
            big_endian: whether an unsigned one is big-endian.
        """
        if big_endian and kind[0] == "u":
            return self.bits(int(kind[1:]))
        if kind == "bool":
            return self._integer("bool", 8, "unsigned", "Boolean")
        bits = int(kind[1:])
        if kind[0] == "f":
            return self._float(kind, bits)
        return self._integer(kind, bits, "unsigned" if kind[0] == "u" else "twosComplement")

    def big_endian(self, kind: str, bits: int) -> str:
        """Add a number with its highest bit first, of any number of bits."""
        if kind[0] == "u":
            return self.bits(bits)
        name = f"{kind}_big_endian_{bits}"
        if not self._is_new(name):
            return name
        if kind[0] == "f":
            found = add(self._set, f"Float{self._what}Type", name=name, sizeInBits=str(bits))
            add(found, "FloatDataEncoding", sizeInBits=str(bits), encoding="IEEE754_1985")
        elif kind == "bool":
            found = add(self._set, f"Boolean{self._what}Type", name=name)
            add(found, "IntegerDataEncoding", sizeInBits=str(bits), encoding="unsigned")
        else:
            found = add(self._set, f"Integer{self._what}Type", name=name, signed="true", sizeInBits=str(bits))
            add(found, "IntegerDataEncoding", sizeInBits=str(bits), encoding="twosComplement")
        return name

    def named(self, kind: str, names: ValueNames, big_endian: bool = False) -> str:
        """Add an integer with named values; bit masks are plain numbers, because XTCE cannot name combinations.

        Args:
            kind: its kind.
            names: the names of its values.
            big_endian: whether it has its highest bit first.
        """
        if names.flags:
            return self.big_endian(kind, int(kind[1:])) if big_endian else self.number(kind)
        name = "_".join([kind, *map(xtce_name, names.values), *(["big_endian"] if big_endian else [])])
        if self._is_new(name):
            found = self._type("Enumerated", name)
            encoding = "unsigned" if kind[0] == "u" else "twosComplement"
            order = "" if big_endian else LITTLE
            add(found, "IntegerDataEncoding", sizeInBits=kind[1:], encoding=encoding, byteOrder=order)
            values = add(found, "EnumerationList")
            for label, number in names.values.items():
                add(values, "Enumeration", value=str(number), label=label)
        return name

    def cell(self, cell: Cell, on_the_wire: bool = False) -> str:
        """Add the type of a cell of a layout; returns its name.

        Args:
            cell: the cell.
            on_the_wire: as in its layout, whose numbers are unsigned then.
        """
        if cell.names is not None:
            return self.named(cell.type, cell.names, cell.big_endian or cell.width % 8 > 0 or cell.bit > 0)
        if cell.measurement is not None and self._what == "Parameter":
            return self.measured(cell.type, cell.measurement, on_the_wire or cell.big_endian)
        if cell.type.startswith("char"):
            return self.text(cell.size)
        if cell.big_endian or cell.width % 8 or cell.bit:
            return self.big_endian(cell.type, cell.width)
        return self.number(cell.type, on_the_wire)

    def measured(self, kind: str, measurement: Measurement, big_endian: bool) -> str:
        """Add a number with a unit, a calibration and limits; a calibrated integer is a float on the ground."""
        name = f"measured{self._measured.setdefault((measurement, big_endian), len(self._measured) + 1)}"
        if not self._is_new(name):
            return name
        bits, is_float = kind[1:], kind[0] == "f"
        if is_float or measurement.is_calibrated:
            found = add(self._set, f"Float{self._what}Type", name=name, sizeInBits=bits if is_float else "64")
        else:
            signed = str(kind[0] == "i").lower()
            found = add(self._set, f"Integer{self._what}Type", name=name, signed=signed, sizeInBits=bits)
        if measurement.unit:
            add(add(found, "UnitSet"), "Unit").text = printable(measurement.unit)
        encoding = "IEEE754_1985" if is_float else "unsigned" if kind[0] == "u" else "twosComplement"
        tag, order = ("Float" if is_float else "Integer"), "" if big_endian else LITTLE
        data = add(found, f"{tag}DataEncoding", sizeInBits=bits, encoding=encoding, byteOrder=order)
        if measurement.is_calibrated:
            _add_calibrator(add(data, "DefaultCalibrator"), measurement)
        if measurement.has_limits:
            _add_alarm(found, measurement)
        return name

    def bits(self, count: int) -> str:
        """Return an unsigned number of the packet header, big-endian."""
        name = f"bits{count}"
        if self._is_new(name):
            kind = add(self._set, f"Integer{self._what}Type", name=name, signed="false", sizeInBits=str(count))
            add(kind, "IntegerDataEncoding", sizeInBits=str(count), encoding="unsigned")
        return name

    def text(self, size: int) -> str:
        """char[size]: a text up to its first NUL."""
        name = f"char{size}"
        if self._is_new(name):
            encoding = add(self._type("String", name), "StringDataEncoding", encoding="UTF-8")
            bits = add(encoding, "SizeInBits")
            add(add(bits, "Fixed"), "FixedValue").text = str(8 * size)
            add(bits, "TerminationChar").text = UTF_8_NUL
        return name

    def padding(self, bits: int) -> str:
        """Add bits without meaning."""
        if bits % 8:
            return self.bits(bits)
        name = f"padding{bits // 8}"
        if self._is_new(name):
            encoding = add(self._type("Binary", name), "BinaryDataEncoding")
            add(add(encoding, "SizeInBits"), "FixedValue").text = str(bits)
        return name

    def counted_text(self, count: str) -> str:
        """Add a text whose number of bytes is given by another parameter."""
        name = f"text_of_{count}"
        if self._is_new(name):
            encoding = add(self._type("String", name), "StringDataEncoding", encoding="UTF-8")
            variable = add(encoding, "Variable", maxSizeInBits=str(MAX_TEXT_BITS))
            _dynamic(variable, count, 8, 0)
        return name

    def counted_bytes(self, count: str, slope: int, intercept: int = 0) -> str:
        """Add bytes whose number of bits is `slope` times another parameter plus `intercept`."""
        name = f"bytes_of_{count}_{slope}" + (f"_{abs(intercept)}" if intercept else "")
        if self._is_new(name):
            encoding = add(self._type("Binary", name), "BinaryDataEncoding")
            _dynamic(add(encoding, "SizeInBits"), count, slope, intercept)
        return name

    def time(self, zero_s: int) -> str:
        """Return the 48 bits of time in a telemetry header: seconds and 65536ths since a Unix time in s."""
        from numpy import datetime64

        name = "spacecraft_time"
        if self._is_new(name):
            kind = self._type("AbsoluteTime", name)
            encoding = add(kind, "Encoding", units="seconds", scale=repr(2**-16))
            add(encoding, "IntegerDataEncoding", sizeInBits="48", encoding="unsigned")
            add(add(kind, "ReferenceTime"), "Epoch").text = str(datetime64(zero_s, "s"))
        return name

    def _is_new(self, name: str) -> bool:
        is_new = name not in self._known
        self._known.add(name)
        return is_new

    def _type(self, kind: str, name: str) -> Element:
        return add(self._set, f"{kind}{self._what}Type", name=name)

    def _integer(self, name: str, bits: int, encoding: str, kind: str = "Integer") -> str:
        if self._is_new(name):
            signed, size = ("", "") if kind == "Boolean" else (str(encoding != "unsigned").lower(), str(bits))
            found = add(self._set, f"{kind}{self._what}Type", name=name, signed=signed, sizeInBits=size)
            add(found, "IntegerDataEncoding", sizeInBits=str(bits), encoding=encoding, byteOrder=LITTLE)
        return name

    def _float(self, name: str, bits: int) -> str:
        if self._is_new(name):
            found = add(self._set, f"Float{self._what}Type", name=name, sizeInBits=str(bits))
            add(found, "FloatDataEncoding", sizeInBits=str(bits), encoding="IEEE754_1985", byteOrder=LITTLE)
        return name


def _add_calibrator(parent: Element, measurement: Measurement) -> None:
    """Add the calibration of a measurement; its lines continue beyond the outer points."""
    if measurement.polynomial:
        polynomial = add(parent, "PolynomialCalibrator")
        for exponent, coefficient in enumerate(measurement.polynomial):
            add(polynomial, "Term", coefficient=repr(float(coefficient)), exponent=str(exponent))
        return
    spline = add(parent, "SplineCalibrator", order="1", extrapolate="true")
    for raw, value in measurement.points:
        add(spline, "SplinePoint", raw=repr(float(raw)), calibrated=repr(float(value)))


def _add_alarm(parent: Element, measurement: Measurement) -> None:
    """Add the limits of a measurement: yellow is XTCE's warning, red is its critical range; good values are inside."""
    ranges = add(add(parent, "DefaultAlarm"), "StaticAlarmRanges")
    for tag, name in (("WarningRange", YELLOW), ("CriticalRange", RED)):
        low, high = measurement.limits(name)
        if (low, high) != (None, None):
            texts = {
                end: repr(float(value))
                for end, value in (("minInclusive", low), ("maxInclusive", high))
                if value is not None
            }
            add(ranges, tag, **texts)


def _dynamic(size: Element, count: str, slope: int, intercept: int) -> None:
    value = add(size, "DynamicValue")
    add(value, "ParameterInstanceRef", parameterRef=count)
    add(value, "LinearAdjustment", slope=str(slope), intercept=str(intercept))


def xtce_of(name: str, dictionary: Dictionary, zero_s: int = UNIX_AT_CFE_EPOCH) -> str:
    """Return the XTCE document of a mission.

    Args:
        name: name of the space system.
        dictionary: its packets; topics of unknown type are left out.
        zero_s: Unix time when spacecraft time is 0, in s.
    """
    system = Element("SpaceSystem", {"name": xtce_name(name), "xmlns": NAMESPACE})
    system.set("xmlns:xsi", "http://www.w3.org/2001/XMLSchema-instance")
    system.set("xsi:schemaLocation", SCHEMA)
    add(system, "Header", version=__version__, validationStatus="Working")
    _Telemetry(add(system, "TelemetryMetaData"), zero_s).add_packets(dictionary.telemetry.values())
    add_commands(add(system, "CommandMetaData"), dictionary.commands.values())
    indent(system)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + tostring(system, encoding="unicode") + "\n"


class _Telemetry:
    """TelemetryMetaData under construction."""

    def __init__(self, parent: Element, zero_s: int) -> None:
        self._types = TypeSet(parent, "Parameter")
        self._parameters = add(parent, "ParameterSet")
        self._containers = add(parent, "ContainerSet")
        self._names: set[str] = set()
        self._add_headers(zero_s)

    def _add_headers(self, zero_s: int) -> None:
        entries = self._container(ROOT, "the CCSDS primary header", is_abstract=True)
        for name, bits in PRIMARY_HEADER:
            self._entry(entries, name, self._types.bits(bits))
        entries = self._container(TELEMETRY, "cFE's telemetry header", is_abstract=True)
        self._entry(entries, "TIME", self._types.time(zero_s))
        self._padding(entries, 32)
        self._base(ROOT, TYPE="0", SEC_HDR_FLG="1")

    def add_packets(self, packets: Iterable[Telemetry | Topic]) -> None:
        """Add a container for each packet with a telemetry header, without which packets cannot be distinguished."""
        taken: set[int] = set()
        for packet in sorted(packets, key=lambda each: (each.msg_id, isinstance(each, Topic))):
            is_usual = isinstance(packet, Telemetry) and packet.header_size == TLM_HEADER_SIZE
            known = is_usual or (isinstance(packet, Topic) and (packet.type or packet.raw))
            if known and packet.msg_id not in taken and _has_time(packet.msg_id):
                taken.add(packet.msg_id)
                if isinstance(packet, Telemetry) and packet.variants:
                    self._add_variants(packet)
                else:
                    self._add(packet)

    def _add_variants(self, packet: Telemetry) -> None:
        """Add packets that share a MsgId: a container with their common part, and one for each."""
        common = self._unique(f"{xtce_name(packet.name)}_any")
        entries = self._container(common, "the common part of all packets of a MsgId", is_abstract=True)
        first = self._unique(f"{common}_first")
        self._entry(entries, first, self._types.number("u8"))
        self._base(TELEMETRY, PKT_APID=str(packet.msg_id & APID_MASK))
        for each in (packet, *packet.variants):
            name = self._unique(xtce_name(each.name))
            entries = self._container(name, each.text)
            self._add_cells(entries, name, [cell for cell in cells_with_padding(each.payload) if cell.offset], each)
            self._base(common, **{first: str(each.first)})

    def _add(self, packet: Telemetry | Topic) -> None:
        name = self._unique(xtce_name(packet.name))
        entries = self._container(name, packet.text)
        apid = str(packet.msg_id & APID_MASK)
        if isinstance(packet, Topic):
            for part in topic_parts(packet, self._types, lambda path: f"{name}_{xtce_name(path)}"):
                self._entry(entries, part.name, part.type)
            flags = {} if packet.raw else {"SEQ_FLGS": WHOLE}
            self._base(TELEMETRY, PKT_APID=apid, **flags)
            return
        self._add_cells(entries, name, cells_with_padding(packet.payload), packet)
        self._base(TELEMETRY, PKT_APID=apid)

    def _add_cells(self, entries: Element, name: str, cells: Iterable[Cell], packet: Telemetry) -> None:
        for cell in cells:
            if cell.type == "padding":
                self._padding(entries, cell.width)
            else:
                kind = self._types.cell(cell, packet.payload.on_the_wire)
                self._entry(entries, self._unique(f"{name}_{xtce_name(cell.path)}"), kind)

    def _unique(self, name: str) -> str:
        """Return the name, with underscores appended until it is unique."""
        while name in self._names:
            name += "_"
        self._names.add(name)
        return name

    def _container(self, name: str, text: str, is_abstract: bool = False) -> Element:
        abstract = "true" if is_abstract else ""
        self._current = add(self._containers, "SequenceContainer", name=name, shortDescription=text, abstract=abstract)
        return add(self._current, "EntryList")

    def _base(self, container: str, **conditions: str) -> None:
        """Set the base of the current container, and the values that distinguish it."""
        criteria = add(add(self._current, "BaseContainer", containerRef=container), "RestrictionCriteria")
        comparisons = add(criteria, "ComparisonList")
        for name, value in conditions.items():
            add(comparisons, "Comparison", parameterRef=name, value=value)

    def _entry(self, entries: Element, name: str, kind: str) -> None:
        add(self._parameters, "Parameter", name=name, parameterTypeRef=kind)
        add(entries, "ParameterRefEntry", parameterRef=name)

    def _padding(self, entries: Element, bits: int) -> None:
        """Use one padding parameter of each size for all packets."""
        kind = self._types.padding(bits)
        name = kind if kind.startswith("padding") else f"padding_{kind}"
        if name not in self._names:
            self._names.add(name)
            add(self._parameters, "Parameter", name=name, parameterTypeRef=kind)
        add(entries, "ParameterRefEntry", parameterRef=name)


class XtceParameter(NamedTuple):
    """A parameter of a topic's container: its name, and the name of its type."""

    name: str
    type: str


class _End(Exception):
    """Exception for a message whose rest cannot be described."""


def topic_parts(topic: Topic, types: TypeSet, name: Callable[[str], str]) -> Iterator[XtceParameter]:
    """Yield the parameters of a topic's packets.

    Args:
        topic: topic of known type, or of whole packets.
        types: receives their types.
        name: returns a parameter's name for a field's path.
    """
    if topic.raw:
        yield XtceParameter(name("data"), _rest(types, 0))
        return
    message = _Message(library_of(topic), types, name)
    try:
        yield from message.fields(topic.type, "")
    except _End:
        if message.fixed_bytes is not None:
            yield XtceParameter(name("rest"), _rest(types, message.fixed_bytes))


def _rest(types: TypeSet, after: int) -> str:
    """Add the rest of a packet after a number of payload bytes; returns the name of the type."""
    return types.counted_bytes("PKT_LEN", 8, 8 * (LENGTH_OFFSET - TLM_HEADER_SIZE - after))


def _has_time(msg_id: int) -> bool:
    """Return whether a MsgId is that of telemetry with its time."""
    return msg_id & (COMMAND_BIT | SECONDARY_HEADER_BIT) == SECONDARY_HEADER_BIT


class _Message:
    """Position in a message; `fixed_bytes` is the offset in bytes, None after a part of variable length."""

    def __init__(self, library: Any, types: TypeSet, name: Callable[[str], str]) -> None:
        self.fixed_bytes: int | None = 0
        self._library = library
        self._types = types
        self._name = name

    def fields(self, kind: str, path: str) -> Iterator[XtceParameter]:
        """Yield the parameters of a message type."""
        for field in self._library.spec(kind).fields:
            inner = f"{path}.{field.name}" if path else field.name
            if field.is_array and field.length is None:
                yield from self._array(field.base, inner)
            elif field.is_array:
                for number in range(field.length):
                    yield from self._value(field.base, f"{inner}[{number}]")
            else:
                yield from self._value(field.base, inner)

    def _value(self, kind: str, path: str) -> Iterator[XtceParameter]:
        if kind in NUMBERS:
            yield self._number(NUMBERS[kind], path)
        elif kind in TIMES:
            for part, number in zip(("secs", "nsecs"), TIMES[kind], strict=True):
                yield self._number(number, f"{path}.{part}")
        elif kind == "string":
            length = self._number("u32", f"{path}.length")
            yield length
            self.fixed_bytes = None
            yield XtceParameter(self._name(path), self._types.counted_text(length.name))
        else:
            yield from self.fields(kind, path)

    def _number(self, kind: str, path: str) -> XtceParameter:
        if self.fixed_bytes is not None:
            self.fixed_bytes += _bits(kind) // 8
        return XtceParameter(self._name(path), self._types.number(kind))

    def _array(self, kind: str, path: str) -> Iterator[XtceParameter]:
        """Yield an array of any length: its count, and its items as bytes."""
        count = self._number("u32", f"{path}.count")
        yield count
        if kind not in NUMBERS:
            raise _End
        self.fixed_bytes = None
        yield XtceParameter(self._name(path), self._types.counted_bytes(count.name, _bits(NUMBERS[kind])))


def _bits(kind: str) -> int:
    return BITS.get(kind) or int(kind[1:])


def add_commands(parent: Element, commands: Iterable[Command]) -> None:
    """Fill a CommandMetaData element.

    Args:
        parent: the element.
        commands: the commands, in any order.
    """
    types = TypeSet(parent, "Argument")
    metas = add(parent, "MetaCommandSet")
    for command in sorted(commands, key=lambda each: (each.msg_id, each.code or 0, each.name)):
        _add_command(metas, types, command)


def _add_command(metas: Element, types: TypeSet, command: Command) -> None:
    name = xtce_name(command.name)
    meta = add(metas, "MetaCommand", name=name, shortDescription=command.text)
    if command.payload.fields:
        arguments = add(meta, "ArgumentList")
        for cell in command.payload.cells():
            add(arguments, "Argument", name=xtce_name(cell.path), argumentTypeRef=types.cell(cell))
    entries = add(add(meta, "CommandContainer", name=name), "EntryList")
    for field, value, size in _command_header(command):
        _fixed(entries, value.to_bytes(size, "big"), field)
    for cell in cells_with_padding(command.payload):
        if cell.type == "padding":
            _fixed(entries, bytes(cell.size), bits=cell.width)
        else:
            add(entries, "ArgumentRefEntry", argumentRef=xtce_name(cell.path))


def _command_header(command: Command) -> Iterable[tuple[str, int, int]]:
    """Name, value and bytes of each field of a command's headers."""
    return (
        ("PACKET_ID", command.msg_id, 2),
        ("SEQUENCE", UNSEGMENTED, 2),
        ("PKT_LEN", command.length - LENGTH_OFFSET, 2),
        ("FUNCTION_CODE", command.code or 0, 1),
        ("CHECKSUM", 0, 1),
    )


def _fixed(entries: Element, value: bytes, name: str = "", bits: int = 0) -> None:
    size = str(bits or 8 * len(value))
    add(entries, "FixedValueEntry", name=name, binaryValue=value.hex(), sizeInBits=size)
