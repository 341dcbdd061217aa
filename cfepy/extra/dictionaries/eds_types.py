"""Data types of electronic data sheets (CCSDS 876.0), as `cfepy.extra.dictionaries.placed_types`."""

from __future__ import annotations

from collections.abc import Iterable

from cfepy.extra.dictionaries.design_parameters import DesignParameters, defined_twice
from cfepy.extra.dictionaries.placed_types import (
    MOST_BITS,
    MOST_CELLS,
    Array,
    Number,
    Padding,
    Struct,
    StructEntry,
    Text,
    Type,
    bits_of,
    cells_of,
)
from cfepy.extra.dictionaries.xml_tags import XmlTag
from cfepy.msg import Measurement, ValueNames
from cfepy.reading.suggestions import did_you_mean

_KINDS = (
    *("AliasDataType", "ArrayDataType", "BinaryDataType", "BooleanDataType", "ContainerDataType", "EnumeratedDataType"),
    *("FloatDataType", "IntegerDataType", "StringDataType", "SubRangeDataType"),
)
_ENTRIES = ("Entry", "PaddingEntry", "FixedValueEntry", "LengthEntry", "ErrorControlEntry")
_FLOATS = {"IEEE754_2008_single": 32, "IEEE754_2008_double": 64}
MOST_DEEP = 60  # types inside each other
_SIGNED = "twosComplement"


class EdsTypes:
    """The data types of all packages.

    Args:
        parameters: values of parameters in attributes.
    """

    def __init__(self, parameters: DesignParameters) -> None:
        self._parameters = parameters
        self._tags: dict[str, XmlTag] = {}
        self._types: dict[str, Type] = {}
        self._derived: dict[str, list[str]] = {}
        self._open: list[str] = []

    def read(self, package: XmlTag) -> None:
        """Read the types of a package.

        Raises:
            UsageError: if a name is missing or defined twice.
        """
        owner = package.need("name")
        for each in package.inside("DataTypeSet"):
            for tag in each.all(*_KINDS):
                name = f"{owner}/{tag.need('name')}"
                if name in self._tags:
                    raise defined_twice(tag, self._tags[name])
                self._tags[name] = tag

    def link(self) -> None:
        """Find the containers that are derived from each container; call it when all packages are read."""
        self._derived.clear()
        for name, tag in self._tags.items():
            if "baseType" in tag.attributes and tag.name == "ContainerDataType":
                base = self._full(self._parameters.text(tag, "baseType"), _package(name))
                self._derived.setdefault(base, []).append(name)

    def names(self) -> Iterable[str]:
        """Return the full names of all types, such as "HS/HkPacket"."""
        return self._tags

    def tag(self, name: str) -> XmlTag:
        """Return the tag of a type by its full name."""
        return self._tags[name]

    def find(self, name: str, package: str, user: XmlTag) -> str:
        """Return the full name of a type.

        Args:
            name: its name, with or without its package.
            package: the package that uses it.
            user: the tag that uses it.

        Raises:
            UsageError: if there is none.
        """
        full = self._full(name, package)
        if full not in self._tags:
            hint = did_you_mean(full, self._tags, "add the file that defines it, or correct the name")
            raise user.fail(f"unknown type {full}; {hint}")
        return full

    def base_of(self, name: str) -> str | None:
        """Return the container from which a container is derived, by their full names; None if there is none."""
        tag = self._tags[name]
        if "baseType" not in tag.attributes or tag.name != "ContainerDataType":
            return None
        return self.find(self._parameters.text(tag, "baseType"), _package(name), tag)

    def derived_from(self, name: str) -> list[str]:
        """Return the containers that are directly derived from a container, in the order of the files."""
        return self._derived.get(name, [])

    def constraints(self, name: str) -> dict[str, str]:
        """Return the values that a container, without its bases, requires of fields: {"Sec.FunctionCode": "3"}."""
        rules = self._tags[name].inside("ConstraintSet", "ValueConstraint")
        return {self._parameters.text(each, "entry"): self._parameters.text(each, "value") for each in rules}

    def type(self, name: str) -> Type:
        """Return a type by its full name.

        Raises:
            UsageError: if it, or a type inside of it, has an error, is too large or contains itself.
        """
        if name in self._types:
            return self._types[name]
        tag = self._tags[name]
        if name in self._open:
            raise tag.fail(f"the type {name} contains itself; correct it")
        if len(self._open) >= MOST_DEEP:
            raise tag.fail(f"types are nested more than {MOST_DEEP} deep; simplify them")
        self._open.append(name)
        try:
            found = self._made(tag, name)
        finally:
            self._open.pop()
        if bits_of(found) > MOST_BITS or cells_of(found) > MOST_CELLS:
            raise tag.fail(f"is larger than {MOST_BITS // 8:,} bytes or {MOST_CELLS:,} values; make it smaller")
        self._types[name] = found
        return found

    def own_struct(self, name: str) -> Struct:
        """Return a container without the fields of its bases; see `type` for the errors."""
        tag = self._tags[name]
        package = _package(name)
        entries = [
            *(each for part in tag.all("EntryList") for each in part.tags),
            *(each for part in tag.all("TrailerEntryList") for each in part.tags),
        ]
        fields: list[StructEntry] = []
        names: set[str] = set()
        for each in entries:
            if each.name == "ListEntry":
                raise each.fail("a list of variable length is not supported; use an ArrayDataType")
            if each.name not in _ENTRIES:
                continue
            found = self._field(each, package)
            if found.name in names:
                raise each.fail("is declared twice; rename one of them")
            names.update({found.name} - {""})
            fields.append(found)
        return Struct(c_name(name), tuple(fields))

    def _full(self, name: str, package: str) -> str:
        return name if "/" in name else f"{package}/{name}"

    def _made(self, tag: XmlTag, name: str) -> Type:
        package = _package(name)
        if tag.name == "ContainerDataType":
            base = self.base_of(name)
            inherited = () if base is None else self._fields_of(base)
            return Struct(c_name(name), (*inherited, *self.own_struct(name).fields))
        if tag.name == "AliasDataType":
            return self.type(self.find(self._parameters.text(tag, "type"), package, tag))
        if tag.name == "SubRangeDataType":
            return self.type(self.find(self._parameters.text(tag, "baseType"), package, tag))
        if tag.name == "ArrayDataType":
            return self._array(tag, package)
        if tag.name == "StringDataType":
            return Text(self._parameters.count(tag, "length", MOST_BITS // 8))
        if tag.name == "BinaryDataType":
            return Array(Number("u", 8), self._bytes(tag))
        return self._number(tag)

    def _fields_of(self, name: str) -> tuple[StructEntry, ...]:
        found = self.type(name)
        assert isinstance(found, Struct)
        return found.fields

    def _bytes(self, tag: XmlTag) -> int:
        encoding = tag.first("BinaryDataEncoding")
        bits = self._parameters.count(tag if encoding is None else encoding, "sizeInBits", MOST_BITS)
        if bits % 8:
            raise tag.fail(f"must have whole bytes, not {bits} bits")
        return bits // 8

    def _field(self, tag: XmlTag, package: str) -> StructEntry:
        text = tag.attributes.get("shortDescription", "")
        if tag.name == "PaddingEntry":
            return StructEntry("", Padding(self._parameters.count(tag, "sizeInBits", MOST_BITS)), tag.line, text)
        full = self.find(self._parameters.text(tag, "type"), package, tag)
        kind = self.type(full)
        if any(tag.all("IntegerDataEncoding", "FloatDataEncoding")) and isinstance(kind, Number):
            kind = self._encoded(tag, kind)
        dimensions = tag.first("ArrayDimensions") or tag.first("DimensionList")
        if dimensions is not None:
            kind = self._dimensioned(kind, dimensions, package)
        unit = tag.attributes.get("unit", "")
        if unit and isinstance(kind, Number) and kind.kind != "bool" and kind.names is None and kind.is_whole:
            kind = kind._replace(measurement=Measurement(kind.word, unit))
        fixed: str | None = None
        if tag.name == "FixedValueEntry":
            fixed = self._parameters.text(tag, "fixedValue")
        return StructEntry(tag.need("name"), kind, tag.line, text, fixed)

    def _array(self, tag: XmlTag, package: str) -> Type:
        item = self.type(self.find(self._parameters.text(tag, "dataTypeRef"), package, tag))
        dimensions = tag.first("DimensionList")
        if dimensions is None:
            raise tag.fail("missing <DimensionList>; add it with a <Dimension>")
        return self._dimensioned(item, dimensions, package)

    def _dimensioned(self, item: Type, dimensions: XmlTag, package: str) -> Type:
        for each in reversed(list(dimensions.all("Dimension"))):
            if "size" in each.attributes:
                count = self._parameters.count(each, "size", MOST_CELLS)
            else:
                count = self._index_count(each, package)
            item = Array(item, count)
            if bits_of(item) > MOST_BITS:
                raise each.fail(f"the array is larger than {MOST_BITS // 8:,} bytes; make it smaller")
        return item

    def _index_count(self, dimension: XmlTag, package: str) -> int:
        """Return the number of items of an array that a type of indices gives: one for each value."""
        full = self.find(self._parameters.text(dimension, "indexTypeRef"), package, dimension)
        tag = self._tags[full]
        if tag.name == "EnumeratedDataType":
            return max(self._labels(tag).values()) + 1
        limits = tag.first("Range", "MinMaxRange")
        if limits is None:
            raise tag.fail("a type of indices must have a <MinMaxRange>; add it")
        rule = limits.attributes.get("rangeType", "inclusiveMinInclusiveMax")
        highest = self._parameters.number(limits, "max")
        count = highest + (0 if "ExclusiveMax" in rule or rule == "lessThan" else 1)
        if not 1 <= count <= MOST_CELLS:
            raise limits.fail(f"the array would have {count} items; expected 1 to {MOST_CELLS:,}")
        return count

    def _number(self, tag: XmlTag) -> Number:
        if tag.name == "BooleanDataType":
            encoding = tag.first("BooleanDataEncoding")
            bits = 1 if encoding is None else self._parameters.count(encoding, "sizeInBits", 64)
            return Number("bool", bits)
        if tag.name == "FloatDataType":
            return self._encoded(tag, Number("f", 32))
        signed = not self._is_unsigned(tag)
        number = self._encoded(tag, Number("i" if signed else "u", self._bits_of_range(tag)))
        labels = self._labels(tag) if tag.name == "EnumeratedDataType" else {}
        return number._replace(names=ValueNames.of(number.word, labels)) if labels else number

    def _encoded(self, tag: XmlTag, number: Number) -> Number:
        encoding = next(tag.all("IntegerDataEncoding", "FloatDataEncoding"), None)
        if encoding is None:
            return number
        big_endian = self._parameters.text_or(encoding, "byteOrder", "bigEndian") != "littleEndian"
        if encoding.name == "FloatDataEncoding":
            precision = self._parameters.text_or(encoding, "encodingAndPrecision", "IEEE754_2008_single")
            if precision not in _FLOATS:
                known = " or ".join(_FLOATS)
                raise encoding.fail(f"the encoding {precision!r} is not supported; expected {known}")
            return number._replace(kind="f", bits=_FLOATS[precision], big_endian=big_endian)
        bits = self._parameters.count(encoding, "sizeInBits", 64)
        rule = self._parameters.text_or(encoding, "encoding", _SIGNED)  # as EdsLib reads it
        if rule not in ("unsigned", _SIGNED):
            raise encoding.fail(f"the encoding {rule!r} is not supported; expected unsigned or {_SIGNED}")
        if not big_endian and bits % 8:
            raise encoding.fail(f"a number of {bits} bits cannot be littleEndian; make it bigEndian")
        return number._replace(kind="i" if rule == _SIGNED else "u", bits=bits, big_endian=big_endian)

    def _labels(self, tag: XmlTag) -> dict[str, int]:
        labels: dict[str, int] = {}
        following = 0
        for each in tag.inside("EnumerationList", "Enumeration"):
            if "value" in each.attributes:
                following = self._parameters.number(each, "value")
            labels[self._parameters.text(each, "label")] = following
            following += 1
        if not labels:
            raise tag.fail("has no <Enumeration>; add its values")
        return labels

    def _is_unsigned(self, tag: XmlTag) -> bool:
        limits = tag.first("Range", "MinMaxRange")
        return limits is None or "min" not in limits.attributes or self._parameters.number(limits, "min") >= 0

    def _bits_of_range(self, tag: XmlTag) -> int:
        """Return the bits for a type without encoding: enough for its highest value."""
        if tag.name == "EnumeratedDataType":
            values = self._labels(tag).values()
            return max(max(values).bit_length(), 1)
        limits = tag.first("Range", "MinMaxRange")
        if tag.first("IntegerDataEncoding") is not None:
            return 32
        if limits is None or "max" not in limits.attributes:
            raise tag.fail("has neither an <IntegerDataEncoding> nor a <MinMaxRange>; add one")
        return max(self._parameters.number(limits, "max").bit_length(), 1)


def _package(name: str) -> str:
    return name.partition("/")[0]


def c_name(name: str) -> str:
    """Return the name of the struct that NASA's tools make of a type: HS/HkPacket is HS_HkPacket_t."""
    return f"{name.replace('/', '_')}_t"
