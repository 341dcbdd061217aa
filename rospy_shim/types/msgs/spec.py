"""ROS .msg text to a `Spec`: fields, constants and their places, by genmsg's rules; its md5sum and full text.

A bare type name belongs to the message's own package, except that `Header` is std_msgs/Header. A string constant is all
text to the right of its `=`, comments included. An error is a UsageError with file and line. Two programs can
communicate only if their md5sums agree. The full text travels in connection headers and bags, so that a reader without
the package can still decode.
"""

from __future__ import annotations

import keyword
import re
from collections.abc import Callable, Iterable
from typing import Any, NamedTuple

from cfepy.reading.input_limits import DEFINITION_BYTES, MESSAGE_FIELDS
from cfepy.reading.mistakes import Mistakes
from cfepy.status import UsageError

PRIMITIVES = {
    "bool": "B", "int8": "b", "uint8": "B", "int16": "h", "uint16": "H", "int32": "i", "uint32": "I",
    "int64": "q", "uint64": "Q", "float32": "f", "float64": "d", "char": "B", "byte": "b",
}  # fmt: skip
"""struct code of each type that has one."""
BUILTINS = frozenset(PRIMITIVES) | {"string", "time", "duration"}
HEADER = "std_msgs/Header"
_RANGES = {
    code: (-(1 << bits - 1), (1 << bits - 1) - 1) if code.islower() else (0, (1 << bits) - 1)
    for code, bits in zip("bBhHiIqQ", (8, 8, 16, 16, 32, 32, 64, 64), strict=True)
}
_TYPE = re.compile(r"([A-Za-z][\w/]*)(\[(\d*)\])?")
_CONSTANT_NAME = re.compile(r"(?!__).*")
_NAME = re.compile(r"[A-Za-z]\w*")
_RESERVED = frozenset(keyword.kwlist) | {"self"}
_LONGEST_TYPE = 250  # characters with the package: folders and files are named after them
_DIGITS = 12  # of the length of an array
_SEPARATOR = "=" * 80 + "\n"


class Field(NamedTuple):
    """One field of a message."""

    name: str
    """Name as in the .msg file."""
    attribute: str
    """Name in Python: a reserved word gets an underscore."""
    base: str
    """Resolved type without the brackets, e.g. "float64" or "std_msgs/Header"."""
    is_array: bool
    length: int | None
    """Length of a fixed array."""
    line: int = 0
    """Its line in its file."""

    @property
    def type(self) -> str:
        """Resolved type with its brackets."""
        if not self.is_array:
            return self.base
        return f"{self.base}[{'' if self.length is None else self.length}]"


class Constant(NamedTuple):
    """One constant of a message."""

    type: str
    name: str
    attribute: str
    value: Any
    text: str
    """Text as written, which enters the md5sum."""
    line: int = 0
    """Its line in its file."""


class Spec(NamedTuple):
    """A parsed message definition."""

    full_name: str
    text: str
    fields: tuple[Field, ...]
    constants: tuple[Constant, ...]
    file: str

    @property
    def has_header(self) -> bool:
        """True if the first field is `Header header`: the publisher stamps and counts such a message."""
        first = self.fields[0] if self.fields else None
        return first is not None and first.name == "header" and first.type == HEADER

    @property
    def message_types(self) -> list[str]:
        """Types of the nested messages, in order, each once."""
        return list(dict.fromkeys(field.base for field in self.fields if field.base not in BUILTINS))


def parse(text: str, full_name: str, file: str, first_line: int = 1, mistakes: Mistakes | None = None) -> Spec:
    """Parse the text of a .msg file.

    Args:
        text: the definition.
        full_name: "package/Name".
        file: path for errors.
        first_line: number of the text's first line in that file.
        mistakes: receives a line that is neither a field nor a constant, a bad name or value, or a field named twice;
            None raises the first error.

    Returns:
        The parsed definition.

    Raises:
        UsageError: the first error.
    """
    package = full_name.rpartition("/")[0]
    fields: list[Field] = []
    constants: list[Constant] = []
    taken: set[str] = set()
    names: set[str] = set()  # of constants
    if len(text) > DEFINITION_BYTES:
        raise UsageError(f"must have at most {DEFINITION_BYTES:,} characters", file=file)
    for number, raw in enumerate(text.split("\n"), first_line):
        line = raw.split("#", 1)[0].strip()
        try:
            if "=" in line:
                constants.append(_constant(line, raw)._replace(line=number))
                names.add(constants[-1].name)
                if constants[-1].name in taken:
                    raise ValueError(f"the constant {constants[-1].name} has the name of a field")
            elif line:
                fields.append(_field(line, package, taken)._replace(line=number))
                taken.add(fields[-1].name)
                if fields[-1].name in names:
                    raise ValueError(f"field {fields[-1].name!r} has the name of a constant")
                if len(fields) + len(constants) > MESSAGE_FIELDS:
                    what = f"a message must have at most {MESSAGE_FIELDS:,} fields; split it"
                    raise UsageError(what, file=file, line=number)
        except UsageError:
            raise
        except (ValueError, OverflowError) as error:
            mistake = UsageError(f"{error}; write `type name` or `type NAME=value`", file=file, line=number)
            if mistakes is None:
                raise mistake from None
            mistakes.add(mistake)
    return Spec(full_name, text, tuple(fields), tuple(constants), file)


def python_name(name: str) -> str:
    """Return the attribute that holds a field, e.g. "from_" for "from"."""
    return name + "_" if name in _RESERVED else name


def _field(line: str, package: str, taken: set[str]) -> Field:
    words = line.split()
    if len(words) != 2:
        raise ValueError(f"{line!r} is not a field")
    kind, name = words
    match = _TYPE.fullmatch(kind)
    if match is None:
        raise ValueError(f"{kind!r} is not a field type")
    if len(kind) > _LONGEST_TYPE:
        raise ValueError(f"{kind[:40]}... is longer than any type: more than {_LONGEST_TYPE} characters")
    if not _NAME.fullmatch(name):
        raise ValueError(f"{name!r} is not a field name")
    if name in taken:
        raise ValueError(f"field {name!r} is defined twice")
    base, brackets, length = match.groups()
    return Field(name, python_name(name), _resolve(base, bool(brackets), package), bool(brackets), _length(length))


def _length(digits: str | None) -> int | None:
    if digits and len(digits) > _DIGITS:
        raise ValueError(f"an array of {digits[:_DIGITS]}... items is too large")
    return int(digits) if digits else None


def _resolve(base: str, is_array: bool, package: str) -> str:
    if base in BUILTINS or "/" in base:
        return base
    # genmsg accepts the bare name for a single Header only, not for an array of them.
    return HEADER if base == "Header" and not is_array else f"{package}/{base}"


def _constant(line: str, raw: str) -> Constant:
    declared, _, text = line.partition("=")
    kind, *names = declared.split()
    if kind == "string":
        text = raw.partition("=")[2]
    elif kind not in PRIMITIVES:
        raise ValueError(f"{kind!r} is not a type for a constant")
    if len(names) != 1 or not _CONSTANT_NAME.fullmatch(names[0]):
        raise ValueError(f"{line!r} is not a constant")
    text = text.strip()
    return Constant(kind, names[0], python_name(names[0]), _value(kind, text), text)


def _value(kind: str, text: str) -> Any:
    if kind == "string":
        return text
    if kind in ("float32", "float64"):
        return float(text)
    if kind == "bool":
        return text == "True" if text in ("True", "False") else bool(int(text))
    number = int(text)
    low, high = _RANGES[PRIMITIVES[kind]]
    if not low <= number <= high:
        raise ValueError(f"{number} does not fit into {kind}")
    return number


_Lookup = Callable[[str], Spec]


def md5_text(spec: Spec, md5sum_of: Callable[[str], str]) -> str:
    """Return the text that is hashed: constants, then fields; a nested message is represented by its own md5sum.

    Args:
        spec: the message.
        md5sum_of: md5sum of a nested type, by full name.
    """
    lines = [f"{constant.type} {constant.name}={constant.text}" for constant in spec.constants]
    lines += [f"{_hashed_type(field, md5sum_of)} {field.name}" for field in spec.fields]
    return "\n".join(lines)


def md5sum(spec: Spec, md5sum_of: Callable[[str], str]) -> str:
    """Return the fingerprint of a message, as 32 hexadecimal digits."""
    return hash_text(md5_text(spec, md5sum_of))


def hash_text(text: str) -> str:
    """Return the md5 of a text; an identity, not a protection."""
    import hashlib

    return hashlib.md5(text.encode(), usedforsecurity=False).hexdigest()


def full_text(spec: Spec, lookup: _Lookup) -> str:
    """Return the definition and the definitions of all types that it needs, each once, in order of first need."""
    parts = [spec.text + "\n"]
    for name in _needs(spec, lookup):
        parts.append(f"{_SEPARATOR}MSG: {name}\n{lookup(name).text}\n")
    return "".join(parts)[:-1]


def split_full_text(text: str) -> Iterable[tuple[str | None, str, int]]:
    """Split a full text. Yields (type name or None for the first, definition, number of its first line)."""
    line = 1
    parts = text.split("\n" + _SEPARATOR)
    for index, part in enumerate(parts):
        name, body = None, part
        if index:
            heading, _, body = part.partition("\n")
            name = heading.removeprefix("MSG:").strip()
            line += 1
        yield name, body, line
        line += body.count("\n") + 2


def _hashed_type(field: Field, md5sum_of: Callable[[str], str]) -> str:
    return field.type if field.base in BUILTINS else md5sum_of(field.base)


def _needs(spec: Spec, lookup: _Lookup) -> dict[str, None]:
    found: dict[str, None] = {}
    for name in spec.message_types:
        found.setdefault(name)
        for deeper in _needs(lookup(name), lookup):
            found.setdefault(deeper)
    return found
