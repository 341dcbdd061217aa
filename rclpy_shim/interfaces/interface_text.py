"""ROS 2's .msg text to an `RosInterface`: fields with defaults and bounds, and constants, by the rules of rosidl.

ROS 2 has more than ROS 1: default values, bounded strings and arrays, `wstring`, names with a package for all types of
other packages. `RosInterface.bus_text` is the same definition in ROS 1's words. It describes the bytes on the Software
Bus, which are the same in both worlds.
"""

from __future__ import annotations

import ast
import re
from typing import Any, NamedTuple

from cfepy.reading.input_limits import DEFINITION_BYTES, MESSAGE_FIELDS
from cfepy.status import UsageError

INTEGERS = {
    "int8": (-(1 << 7), (1 << 7) - 1), "uint8": (0, (1 << 8) - 1), "int16": (-(1 << 15), (1 << 15) - 1),
    "uint16": (0, (1 << 16) - 1), "int32": (-(1 << 31), (1 << 31) - 1), "uint32": (0, (1 << 32) - 1),
    "int64": (-(1 << 63), (1 << 63) - 1), "uint64": (0, (1 << 64) - 1), "char": (0, 255), "byte": (0, 255),
}  # fmt: skip
"""The smallest and the largest value of each type of whole numbers."""
FLOATS = ("float32", "float64")
STRINGS = ("string", "wstring")
PRIMITIVES = frozenset([*INTEGERS, *FLOATS, *STRINGS, "bool"])
TIMES = {"builtin_interfaces/Time": "time", "builtin_interfaces/Duration": "duration"}
"""The messages that are built-in types in ROS 1, with the same bytes."""
HEADER = "std_msgs/Header"
SEQ = "seq"
"""The counter of ROS 1's header, which a ROS 2 node does not see."""
_TYPE = re.compile(
    r"(?P<base>[A-Za-z]\w*(?:/[A-Za-z]\w*)?)(?:<=(?P<text>\d{1,9}))?(?P<array>\[(?P<bound><=)?(?P<length>\d{0,9})\])?"
)
_FIELD_NAME = re.compile(r"(?!.*__)(?!.*_$)[a-z][a-z0-9_]*")
_CONSTANT_NAME = re.compile(r"(?!.*__)(?!.*_$)[A-Z][A-Z0-9_]*")
_TRUTH = {"true": True, "1": True, "false": False, "0": False}


class InterfaceField(NamedTuple):
    """One field of a message.

    Attributes:
        name: its name.
        base: type of one value, such as "float64" or "std_msgs/Header".
        is_array: True for an array or a sequence.
        length: length of an array, or the bound of a sequence; None for neither.
        is_bounded: True if `length` is a bound.
        text_bound: maximum number of characters of a string; None for no limit.
        default: its default value as Python has it; None for the default of its type.
    """

    name: str
    base: str
    is_array: bool = False
    length: int | None = None
    is_bounded: bool = False
    text_bound: int | None = None
    default: Any = None

    @property
    def fixed_length(self) -> int | None:
        """Length of an array; None for a sequence or a single value."""
        return None if self.is_bounded else self.length


class InterfaceConstant(NamedTuple):
    """One constant of a message."""

    name: str
    base: str
    value: Any


class RosInterface(NamedTuple):
    """A parsed definition."""

    full_name: str
    fields: tuple[InterfaceField, ...]
    constants: tuple[InterfaceConstant, ...]

    def bus_text(self) -> str:
        """Return the definition in ROS 1's words, without defaults and bounds."""
        lines = [f"{_bus_base(each.base)} {each.name}={_constant_text(each)}" for each in self.constants]
        if self.full_name == HEADER:
            lines.append(f"uint32 {SEQ}")
        for field in self.fields:
            base = TIMES.get(field.base, _bus_base(field.base))
            brackets = "" if not field.is_array else f"[{'' if field.fixed_length is None else field.fixed_length}]"
            lines.append(f"{base}{brackets} {field.name}")
        return "".join(f"{line}\n" for line in lines)


def _bus_base(base: str) -> str:
    return "string" if base == "wstring" else base


def _constant_text(constant: InterfaceConstant) -> str:
    return str(int(constant.value)) if constant.base == "bool" else str(constant.value)


def parse_interface(text: str, full_name: str, file: str, first_line: int = 1) -> RosInterface:
    """Parse the text of a .msg file, or of a part of a .srv file.

    Args:
        text: the definition.
        full_name: "package/Name".
        file: path for errors.
        first_line: number of the text's first line in that file.

    Returns:
        The definition.

    Raises:
        UsageError: a line is neither a field nor a constant, or a name or a value is invalid.
    """
    if len(text) > DEFINITION_BYTES:
        raise UsageError(f"must have at most {DEFINITION_BYTES:,} characters", file=file)
    package = full_name.partition("/")[0]
    fields: dict[str, InterfaceField] = {}
    constants: dict[str, InterfaceConstant] = {}
    for number, raw in enumerate(text.split("\n"), first_line):
        line = raw.split("#", 1)[0].strip()
        if not line:
            continue
        try:
            kind, name, rest, is_constant = _split(line)
            if name in fields or name in constants:
                raise ValueError(f"{name!r} is defined twice")
            field = _field(kind, name, package)
            if is_constant:
                constants[name] = _constant(field, rest)
            else:
                fields[name] = field._replace(default=_default(field, rest)) if rest else _checked(field)
            if len(fields) + len(constants) > MESSAGE_FIELDS:
                raise ValueError(f"a message must have at most {MESSAGE_FIELDS:,} fields; split it")
        except ValueError as error:
            raise UsageError(str(error), file=file, line=number) from None
    return RosInterface(full_name, tuple(fields.values()), tuple(constants.values()))


def _split(line: str) -> tuple[str, str, str, bool]:
    """Return type, name, the text after the name, and True for a constant."""
    kind, *rest = line.split(None, 1)
    if not rest:
        raise ValueError(f"{line!r} is not a field; write `type name`, `type name default` or `type NAME=value`")
    name, equals, value = rest[0].partition("=")
    if equals:
        return kind, name.strip(), value.strip(), True
    name, *given = rest[0].split(None, 1)
    return kind, name, given[0].strip() if given else "", False


def _field(kind: str, name: str, package: str) -> InterfaceField:
    match = _TYPE.fullmatch(kind)
    if match is None:
        raise ValueError(f"invalid type {kind!r}; expected such as int32, string<=10, geometry_msgs/Pose or float64[9]")
    base = match["base"]
    if match["text"] is not None and base not in STRINGS:
        raise ValueError(f"invalid type {kind!r}; only strings have a bound")
    if base not in PRIMITIVES and "/" not in base:
        base = f"{package}/{base}"
    length = int(match["length"]) if match["length"] else None
    if (match["bound"] and length is None) or length == 0:
        raise ValueError(f"invalid type {kind!r}; expected a length of at least 1")
    bound = int(match["text"]) if match["text"] is not None else None
    return InterfaceField(name, base, bool(match["array"]), length, bool(match["bound"]), bound)


def _checked(field: InterfaceField) -> InterfaceField:
    if not _FIELD_NAME.fullmatch(field.name):
        raise ValueError(
            f"invalid field name {field.name!r}; expected small letters, digits and single underscores between them"
        )
    return field


def _constant(field: InterfaceField, text: str) -> InterfaceConstant:
    if not _CONSTANT_NAME.fullmatch(field.name):
        raise ValueError(
            f"invalid constant name {field.name!r}; expected capitals, digits and single underscores between them"
        )
    if field.is_array or field.base not in PRIMITIVES:
        raise ValueError(f"constant {field.name} must be a number, a bool or a string")
    return InterfaceConstant(field.name, field.base, _single(field, text))


def _default(field: InterfaceField, text: str) -> Any:
    _checked(field)
    if field.base not in PRIMITIVES:
        raise ValueError(f"field {field.name!r} is a message and cannot have a default value")
    if not field.is_array:
        return _octet(field, _single(field, text))
    if not text.startswith("[") or not text.endswith("]"):
        raise ValueError(f"default of {field.name!r} must be in brackets, not {text!r}")
    values = [_octet(field, _single(field, item)) for item in _items(text[1:-1])]
    length = field.length
    if length is not None and (len(values) > length or (not field.is_bounded and len(values) < length)):
        raise ValueError(f"default of {field.name!r} must have {length} values, not {len(values)}")
    return values


def _octet(field: InterfaceField, value: Any) -> Any:
    return bytes([value]) if field.base == "byte" else value


def _items(text: str) -> list[str]:
    """Split values at commas outside of quotes."""
    items, quote, start = [], "", 0
    for at, character in enumerate(text):
        if quote:
            quote = "" if character == quote and text[at - 1] != "\\" else quote
        elif character in "\"'":
            quote = character
        elif character == ",":
            items.append(text[start:at].strip())
            start = at + 1
    last = text[start:].strip()
    return [*items, last] if last else items


def _single(field: InterfaceField, text: str) -> Any:
    """Return one value.

    Raises:
        ValueError: the text is not a value of the type.
    """
    base = field.base
    if base in STRINGS:
        return _string(field, text)
    if base == "bool":
        if text.lower() not in _TRUTH:
            raise ValueError(f"invalid value {text!r} of {field.name}; expected true or false")
        return _TRUTH[text.lower()]
    if base in FLOATS:
        return float(text)
    number = int(text, 0) if not text.lstrip("+-").isdigit() else int(text)
    low, high = INTEGERS[base]
    if not low <= number <= high:
        raise ValueError(f"value {number} of {field.name} does not fit into {base}")
    return number


def _string(field: InterfaceField, text: str) -> str:
    if len(text) >= 2 and text[0] == text[-1] and text[0] in "\"'":
        try:
            text = str(ast.literal_eval(text))
        except (SyntaxError, ValueError):
            text = text[1:-1]
    if field.text_bound is not None and len(text) > field.text_bound:
        raise ValueError(f"value of {field.name} must have at most {field.text_bound} characters, not {len(text)}")
    return text
