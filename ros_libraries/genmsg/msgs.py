"""`MsgSpec` and its parts: types, fields and constants."""

from __future__ import annotations

import re
from typing import Any

from .base import SEP, InvalidMsgSpec
from .names import is_legal_resource_base_name, is_legal_resource_name, package_resource_name

HEADER, TIME, DURATION = "Header", "time", "duration"
HEADER_FULL_NAME = "std_msgs/Header"
TIME_MSG = "uint32 secs\nuint32 nsecs"
DURATION_MSG = "int32 secs\nint32 nsecs"

# fmt: off
PRIMITIVE_TYPES = [
    "int8", "uint8", "int16", "uint16", "int32", "uint32", "int64", "uint64", "float32", "float64", "string", "bool",
    "char", "byte",
]
# fmt: on
BUILTIN_TYPES = [*PRIMITIVE_TYPES, TIME, DURATION]

_BRACKETS = re.compile(r"(\[\d*\])*")

EXT_MSG, MSG_DIR = ".msg", "msg"


def bare_msg_type(msg_type: Any) -> Any:
    """Return a type without its brackets."""
    return None if msg_type is None else msg_type.partition("[")[0]


def resolve_type(msg_type: str, package_context: str) -> str:
    """Return the full name of a type, as used in a definition of a package."""
    bare = bare_msg_type(msg_type)
    if bare == HEADER:
        return HEADER_FULL_NAME
    return msg_type if is_builtin(bare) or SEP in msg_type else f"{package_context}{SEP}{msg_type}"


def parse_type(msg_type: str) -> tuple[str, bool, int | None]:
    """Return (type without brackets, whether it is an array, length of a fixed array).

    Raises:
        ValueError: an empty type, more than one dimension, or a length that is not a number.
    """
    if not msg_type:
        raise ValueError("Invalid empty type")
    base, bracket, length = msg_type.partition("[")
    if "[" in length:
        raise ValueError(f"Currently only support 1-dimensional array types: {msg_type}")
    if not bracket or length == "]":
        return base, bool(bracket), None
    try:
        return base, True, int(length[:-1])
    except ValueError:
        raise ValueError(f"Invalid array dimension: [{length[:-1]}]") from None


def is_valid_msg_type(x: str) -> bool:
    """Return whether a type, with its brackets, is written as one can be."""
    if not x or x != x.strip():
        return False
    base = bare_msg_type(x)
    return is_legal_resource_name(base) and _BRACKETS.fullmatch(x[len(base) :]) is not None


def is_valid_constant_type(x: str) -> bool:
    """Return whether there can be constants of a type."""
    return x in PRIMITIVE_TYPES


def is_valid_msg_field_name(x: str) -> bool:
    """Return whether a field can have a name."""
    return is_legal_resource_base_name(x)


def is_builtin(msg_type_name: str) -> bool:
    """Return whether a type belongs to the language."""
    return msg_type_name in BUILTIN_TYPES


def is_header_type(msg_type: str) -> bool:
    """Return whether a type is the header, under any of its names."""
    return msg_type in (HEADER, HEADER_FULL_NAME, "roslib/Header")


class Constant:
    """A constant: `type`, `name`, its value `val`, and `val_text`, the value as written."""

    __slots__ = ("name", "type", "val", "val_text")
    __hash__ = None  # type: ignore[assignment]

    def __init__(self, type_: str, name: str, val: Any, val_text: str) -> None:
        if None in (type_, name, val_text) or val is None:
            raise ValueError("Constant must have non-None parameters")
        self.type, self.name, self.val, self.val_text = type_, name.strip(), val, val_text

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Constant):
            return False
        return (self.type, self.name, self.val) == (other.type, other.name, other.val)

    def __repr__(self) -> str:
        return f"{self.type} {self.name}={self.val}"


class Field:
    """A field: `name`, `type`, `base_type`, `is_array`, `array_len`, `is_builtin`, `is_header`."""

    __hash__ = None  # type: ignore[assignment]

    def __init__(self, name: str, type: str) -> None:
        self.name, self.type = name, type
        self.base_type, self.is_array, self.array_len = parse_type(type)
        self.is_header, self.is_builtin = is_header_type(type), is_builtin(self.base_type)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Field) and (self.name, self.type) == (other.name, other.type)

    def __repr__(self) -> str:
        return f"[{self.name}, {self.type}, {self.base_type}, {self.is_array}, {self.array_len}]"


class MsgSpec:
    """A message definition.

    Args:
        types: types of the fields.
        names: names of the fields.
        constants: the constants.
        text: the definition.
        full_name: "package/Name".
        package: package of the message; by default from the full name.
        short_name: its bare name; by default from the full name.

    Raises:
        InvalidMsgSpec: two fields have one name, or a type is invalid.
    """

    __hash__ = None  # type: ignore[assignment]

    def __init__(
        self,
        types: list[str],
        names: list[str],
        constants: list[Constant],
        text: str,
        full_name: str,
        package: str = "",
        short_name: str = "",
    ) -> None:
        if len(set(names)) != len(names):
            raise InvalidMsgSpec(f"Duplicate field names in message: {names}")
        assert len(types) == len(names), f"len({types}) != len({names})"
        own_package, own_name = package_resource_name(full_name)
        self.types, self.names, self.constants, self.text = types, names, constants, text
        self.full_name, self.short_name, self.package = full_name, short_name or own_name, package or own_package
        self.header_present = self.fields()[:1] == [(HEADER_FULL_NAME, "header")]
        try:
            self._parsed_fields = [Field(name, kind) for kind, name in self.fields()]
        except ValueError as error:
            raise InvalidMsgSpec(f"invalid field: {error}") from None

    def fields(self) -> list[tuple[str, str]]:
        """(type, name) of the fields."""
        return list(zip(self.types, self.names, strict=True))

    def parsed_fields(self) -> list[Field]:
        """Return the fields."""
        return self._parsed_fields

    def has_header(self) -> bool:
        """Return whether the first field is `Header header`."""
        return self.header_present

    def _parts(self) -> tuple[Any, ...]:
        return self.types, self.names, self.constants, self.text, self.full_name, self.short_name, self.package

    def __eq__(self, other: object) -> bool:
        return isinstance(other, MsgSpec) and self._parts() == other._parts()

    def __repr__(self) -> str:
        parts = [repr(self.constants)] if self.constants else []
        return f"MsgSpec[{', '.join([*parts, repr(self.types), repr(self.names)])}]"

    def __str__(self) -> str:
        return self.text
