"""Types of XTCE parameters and arguments: C's numbers and texts, little-endian as the flight software stores them.

Each type is put into its set when something first refers to it. Imports only the standard library.
"""

from __future__ import annotations

from xml.etree.ElementTree import Element, SubElement

LITTLE = "leastSignificantByteFirst"
UTF_8_NUL = "00"
MAX_TEXT_BITS = 8 * 32768


def add(parent: Element, tag: str, **attributes: str) -> Element:
    """A new element below another; a value of "" leaves its attribute out."""
    return SubElement(parent, tag, {name: value for name, value in attributes.items() if value})


class TypeSet:
    """A ParameterTypeSet or an ArgumentTypeSet.

    Args:
        parent: the element that gets the set.
        what: "Parameter" or "Argument".
    """

    def __init__(self, parent: Element, what: str) -> None:
        self._what = what
        self._set = add(parent, f"{what}TypeSet")
        self._known: set[str] = set()

    def number(self, kind: str) -> str:
        """A number or bool in C's representation, such as "u16", "i8", "f64"; the name of the type."""
        if kind == "bool":
            return self._integer("bool", 8, "unsigned", "Boolean")
        bits = int(kind[1:])
        if kind[0] == "f":
            return self._float(kind, bits)
        return self._integer(kind, bits, "unsigned" if kind[0] == "u" else "twosComplement")

    def bits(self, count: int) -> str:
        """An unsigned number of the packet header, big-endian."""
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

    def padding(self, size: int) -> str:
        """Bytes that mean nothing."""
        name = f"padding{size}"
        if self._is_new(name):
            encoding = add(self._type("Binary", name), "BinaryDataEncoding")
            add(add(encoding, "SizeInBits"), "FixedValue").text = str(8 * size)
        return name

    def counted_text(self, count: str) -> str:
        """A text whose number of bytes another parameter tells."""
        name = f"text_of_{count}"
        if self._is_new(name):
            encoding = add(self._type("String", name), "StringDataEncoding", encoding="UTF-8")
            variable = add(encoding, "Variable", maxSizeInBits=str(MAX_TEXT_BITS))
            _dynamic(variable, count, 8, 0)
        return name

    def counted_bytes(self, count: str, slope: int, intercept: int = 0) -> str:
        """Bytes whose number of bits is `slope` times what another parameter tells, plus `intercept`."""
        name = f"bytes_of_{count}_{slope}" + (f"_{abs(intercept)}" if intercept else "")
        if self._is_new(name):
            encoding = add(self._type("Binary", name), "BinaryDataEncoding")
            _dynamic(add(encoding, "SizeInBits"), count, slope, intercept)
        return name

    def time(self) -> str:
        """The 48 bits of time in a telemetry header: seconds and 65536ths since cFE's epoch."""
        name = "spacecraft_time"
        if self._is_new(name):
            kind = self._type("AbsoluteTime", name)
            encoding = add(kind, "Encoding", units="seconds", scale=repr(2**-16))
            add(encoding, "IntegerDataEncoding", sizeInBits="48", encoding="unsigned")
            add(add(kind, "ReferenceTime"), "Epoch").text = "1980-01-01T00:00:00"
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


def _dynamic(size: Element, count: str, slope: int, intercept: int) -> None:
    value = add(size, "DynamicValue")
    add(value, "ParameterInstanceRef", parameterRef=count)
    add(value, "LinearAdjustment", slope=str(slope), intercept=str(intercept))
