"""C++ headers of messages, services and actions, as gencpp makes them for roscpp: `#include <std_msgs/String.h>`.

They are made from the definitions of `rospy_shim.types.msgs`, which cfepy's own Python nodes use. A struct has the
parts of gencpp's that public nodes use: `_field_type`, `Ptr`, `ConstPtr`, constants, `==`, `<<`. With it come the
visitor of its fields (`roscfe::wire::Fields`) and its other properties (`roscfe::wire::Traits`); see roscfe/include. In
the strict profile nothing allocates: a text and an array have a capacity there, one for each field.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from enum import StrEnum
from pathlib import Path

from cfepy.extra.convert.capacities import Capacities
from cfepy.reading.contained_files import place_contained, write_contained
from cfepy.status import UsageError
from rospy_shim.types.msgs import Library
from rospy_shim.types.msgs.spec import PRIMITIVES, Constant, Field, Spec

__all__ = ["Profile", "write_headers"]

_LEAST = {"B": 1, "b": 1, "h": 2, "H": 2, "i": 4, "I": 4, "q": 8, "Q": 8, "f": 4, "d": 8}
_NUMBERS = {
    "bool": "uint8_t", "int8": "int8_t", "uint8": "uint8_t", "byte": "int8_t", "char": "uint8_t", "int16": "int16_t",
    "uint16": "uint16_t", "int32": "int32_t", "uint32": "uint32_t", "int64": "int64_t", "uint64": "uint64_t",
    "float32": "float", "float64": "double", "time": "ros::Time", "duration": "ros::Duration",
}  # fmt: skip
_KEYWORDS = frozenset({
    "alignas", "alignof", "and", "and_eq", "asm", "auto", "bitand", "bitor", "bool", "break", "case", "catch", "char",
    "char16_t", "char32_t", "class", "compl", "const", "constexpr", "const_cast", "continue", "decltype", "default",
    "delete", "do", "double", "dynamic_cast", "else", "enum", "explicit", "export", "extern", "false", "float", "for",
    "friend", "goto", "if", "inline", "int", "long", "mutable", "namespace", "new", "noexcept", "not", "not_eq",
    "nullptr", "operator", "or", "or_eq", "private", "protected", "public", "register", "reinterpret_cast", "return",
    "short", "signed", "sizeof", "static", "static_assert", "static_cast", "struct", "switch", "template", "this",
    "thread_local", "throw", "true", "try", "typedef", "typeid", "typename", "union", "unsigned", "using", "virtual",
    "void", "volatile", "wchar_t", "while", "xor", "xor_eq",
})  # fmt: skip
_PARTS = ("Request", "Response")
_IN_ENUM = frozenset(PRIMITIVES) - {"bool", "int64", "uint64", "float32", "float64"}
_LONGEST_LITERAL = 2000  # characters of a definition's line in one string literal


class Profile(StrEnum):
    """The form of messages; see docs/reference/roscfe.md."""

    HOST = "host"
    """std::string and std::vector."""
    POOL = "pool"
    """As in host, but they allocate on the node's own arena."""
    STRICT = "strict"
    """Strings and vectors of a fixed capacity."""


def write_headers(
    types: Iterable[str], folder: Path, profile: Profile, library: Library, capacities: Capacities | None = None
) -> list[Path]:
    """Write the headers of types and of all types in them, each to `folder/package/Name.h`.

    A file that already has the right text is not written, so that files compiled with it stay valid.

    Args:
        types: full names of messages or services, e.g. "std_msgs/String", "std_srvs/SetBool".
        folder: for the include path of a compiler.
        profile: the form of the messages.
        library: the definitions, e.g. `rospy_shim.types.msgs.shipped()`.
        capacities: of the fields, for the strict profile; None for the defaults.

    Returns:
        The files, sorted.

    Raises:
        UsageError: no such type, a mistake in its definition, or a field without a capacity.
    """
    folder.mkdir(parents=True, exist_ok=True)
    maker = _Maker(library, profile, capacities or Capacities())
    written = []
    for name, text in sorted(maker.headers(types).items()):
        path = place_contained(folder, f"/{name}.h")
        if not path.is_file() or path.read_bytes() != text.encode():
            write_contained(folder, f"/{name}.h", text.encode())
        written.append(path)
    return written


class _Maker:
    """Makes the texts of headers, each type once."""

    def __init__(self, library: Library, profile: Profile, capacities: Capacities) -> None:
        self._library = library
        self._profile = profile
        self._capacities = capacities
        self._sizes: dict[str, tuple[int, bool]] = {}

    def headers(self, types: Iterable[str]) -> dict[str, str]:
        """Return texts by full name: of messages and services, and of all messages that they need."""
        made: dict[str, str] = {}
        wanted = list(types)
        while wanted:
            name = wanted.pop()
            if name in made:
                continue
            if not self._library.has(name) and self._library.has(name, "srv"):
                made[name] = self._service(name)
                wanted += [name + part for part in _PARTS]
            else:
                spec = self._library.spec(name)
                made[name] = self._message(spec)
                wanted += spec.message_types
        return made

    def _message(self, spec: Spec) -> str:
        package, _, name = spec.full_name.partition("/")
        _check_name(spec)
        least, fixed = self._size(spec.full_name)
        macros = sorted({each.name for each in spec.constants} | {f.name for f in spec.fields if f.name.isupper()})
        cpp = f"{package}::{name}"
        lines = [
            f"// {spec.full_name}, {self._profile.value} profile. Made by cfepy from its definition; changes get lost.",
            *_guard(package, name),
            '#include "roscfe/message.h"',
            *(f"#include <{nested}.h>" for nested in sorted(spec.message_types)),
            "",
            *_without_macros(macros, "push"),
            f"namespace {package}",
            "{",
            "",
            f"struct {name}",
            "{",
            f"    typedef {name} Type;",
            "",
            *self._fields(spec),
            *self._constants(spec.constants),
            f"    typedef boost::shared_ptr<{name}>       Ptr;",
            f"    typedef boost::shared_ptr<{name} const> ConstPtr;",
            "};",
            "",
            f"typedef boost::shared_ptr<{name}>       {name}Ptr;",
            f"typedef boost::shared_ptr<{name} const> {name}ConstPtr;",
            "",
            "template <class>",
            f"using {name}_ = {name};",
            "",
            *_operators(name, spec.fields),
            f"}} // namespace {package}",
            "",
            *_known_to_wire(
                f"Fields<{cpp}>",
                f"    static constexpr std::size_t kLeast = {least};",
                f"    static constexpr bool        kFixed = {_bool(fixed)};",
                "",
                *_visitor("visit", "Stream", "stream", (f"next(message.{_cpp_name(f.name)})" for f in spec.fields)),
                "",
                *_visitor(
                    "print", "Printer", "out", (f'field("{f.name}", message.{_cpp_name(f.name)})' for f in spec.fields)
                ),
                "};",
                "",
                "template <>",
                f"struct Traits<{cpp}>",
                "{",
                f"    static constexpr bool has_header = {_bool(spec.has_header)};",
                f"    static constexpr bool is_fixed_size = {_bool(fixed)};",
                "",
                *_names(self._library.md5sum(spec.full_name), spec.full_name),
                "    static const char *definition()",
                "    {",
                *_literal(self._library.full_text(spec.full_name)),
                "    }",
                *self._service_traits(spec.full_name),
            ),
            *_without_macros(macros, "pop"),
            "#endif",
            "",
        ]
        return "\n".join(lines)

    def _service(self, full_name: str) -> str:
        package, _, name = full_name.partition("/")
        md5 = self._library.service_class(full_name)._md5sum
        lines = [
            f"// {full_name}, a service. Made by cfepy from its definition; changes get lost.",
            *_guard(package, name),
            *(f"#include <{full_name}{part}.h>" for part in _PARTS),
            "",
            '#include "roscfe/message.h"',
            "",
            f"namespace {package}",
            "{",
            "",
            f"struct {name}",
            "{",
            f"    typedef {name}Request  Request;",
            f"    typedef {name}Response Response;",
            "    typedef Request  RequestType;",
            "    typedef Response ResponseType;",
            "",
            "    Request  request;",
            "    Response response;",
            "};",
            "",
            f"}} // namespace {package}",
            "",
            *_known_to_wire(f"Traits<{package}::{name}>", *_names(md5, full_name)),
            "#endif",
            "",
        ]
        return "\n".join(lines)

    def _service_traits(self, full_name: str) -> Iterator[str]:
        """Yield the lines by which a request and a response know their service."""
        for part in _PARTS:
            service = full_name.removesuffix(part)
            if full_name.endswith(part) and not self._library.has(full_name) and self._library.has(service, "srv"):
                md5 = self._library.service_class(service)._md5sum
                yield from _names(md5, service, "service_")

    def _fields(self, spec: Spec) -> Iterator[str]:
        for each in spec.fields:
            name = _cpp_name(each.name)
            yield f"    typedef {self._type(spec.full_name, each)} _{each.name}_type;"
            yield f"    _{each.name}_type {name}{{}};"
            yield ""

    def _type(self, owner: str, each: Field) -> str:
        """Return the C++ type of a field."""
        place = f"{owner}.{each.name}"
        item = _NUMBERS.get(each.base) or "::" + each.base.replace("/", "::")
        if each.base == "string":
            item = self._text_type(place + "[]" if each.is_array else place)
        if not each.is_array:
            return item
        if each.length is not None:
            return f"boost::array<{item}, {each.length}>"
        if self._profile is Profile.STRICT:
            return f"roscfe::FixedVector<{item}, {self._capacities.of_array(place, each.base)}>"
        return f"std::vector<{item}>"

    def _text_type(self, place: str) -> str:
        if self._profile is Profile.STRICT:
            return f"roscfe::FixedString<{self._capacities.of_text(place)}>"
        return "std::string"

    def _constants(self, constants: Iterable[Constant]) -> Iterator[str]:
        written = False
        for each in constants:
            written = True
            name = _cpp_name(each.name)
            if each.type == "string":
                fixed = f"roscfe::FixedString<{len(each.value.encode())}>"
                kind = "std::string" if self._profile is Profile.HOST else fixed
                yield f"    inline static const {kind} {name}{{{_quoted(each.value)}}};"
            elif each.type in _IN_ENUM:  # as in gencpp: such a constant is printed as a number, not as a letter
                suffix = "u" if PRIMITIVES[each.type].isupper() else ""
                low = each.value == -(1 << 31)
                yield f"    enum {{ {name} = {'-2147483647 - 1' if low else f'{each.value}{suffix}'} }};"
            else:
                yield f"    static constexpr {_NUMBERS[each.type]} {name} = {_number(each)};"
        if written:
            yield ""

    def _size(self, full_name: str) -> tuple[int, bool]:
        """Return the fewest bytes of a message, and whether it always has this size."""
        if full_name not in self._sizes:
            sizes = [self._field_size(each) for each in self._library.spec(full_name).fields]
            self._sizes[full_name] = sum(least for least, _ in sizes), all(fixed for _, fixed in sizes)
        return self._sizes[full_name]

    def _field_size(self, each: Field) -> tuple[int, bool]:
        if each.is_array and each.length is None:
            return 4, False
        if each.base == "string":
            least, fixed = 4, False
        elif each.base in ("time", "duration"):
            least, fixed = 8, True
        elif each.base in PRIMITIVES:
            least, fixed = _LEAST[PRIMITIVES[each.base]], True
        else:
            least, fixed = self._size(each.base)
        count = each.length if each.is_array and each.length is not None else 1
        return least * count, fixed or count == 0


def _check_name(spec: Spec) -> None:
    package, _, name = spec.full_name.partition("/")
    for word in (package, name):
        if not re.fullmatch(r"[A-Za-z]\w*", word, re.ASCII) or word in _KEYWORDS:
            raise UsageError(f"{spec.full_name} is not a valid name in C++", file=spec.file)


def _known_to_wire(first: str, *lines: str) -> Iterator[str]:
    """Yield specialisations of the templates in roscfe/wire.h for a type; the first one is named."""
    yield from ("namespace roscfe", "{", "namespace wire", "{", "", "template <>", f"struct {first}", "{")
    yield from lines
    yield from ("};", "", "} // namespace wire", "} // namespace roscfe", "")


def _names(md5: str, full_name: str, which: str = "") -> Iterator[str]:
    """Yield a type's sum and its name."""
    yield f'    static const char *{which}md5() {{ return "{md5}"; }}'
    yield f'    static const char *{which}type() {{ return "{full_name}"; }}'


def _cpp_name(name: str) -> str:
    """Return a field's name in C++. A keyword gets an underscore, as genpy does for keywords of Python."""
    return name + "_" if name in _KEYWORDS else name


def _guard(package: str, name: str) -> list[str]:
    guard = f"ROSCFE_MESSAGE_{package}_{name}_H"  # as it is: names may differ in their capitals alone
    return [f"#ifndef {guard}", f"#define {guard}", ""]


def _without_macros(names: Iterable[str], verb: str) -> Iterator[str]:
    """Yield lines that protect names such as DEBUG, NAN or ERROR, which are macros on some platforms."""
    empty = True
    for name in names:
        empty = False
        yield f'#pragma {verb}_macro("{name}")'
        if verb == "push":
            yield f"#undef {name}"
    if not empty:
        yield ""


def _operators(name: str, fields: tuple[Field, ...]) -> Iterator[str]:
    a, b = ("a", "b") if fields else ("", "")
    same = [f"a.{_cpp_name(each.name)} == b.{_cpp_name(each.name)}" for each in fields]
    yield f"inline bool operator==(const {name} &{a}, const {name} &{b})"
    yield "{"
    yield "    return " + " &&\n           ".join(same or ["true"]) + ";"
    yield "}"
    yield ""
    yield f"inline bool operator!=(const {name} &a, const {name} &b)"
    yield "{"
    yield "    return !(a == b);"
    yield "}"
    yield ""
    yield f"inline std::ostream &operator<<(std::ostream &os, const {name} &message)"
    yield "{"
    yield f'    ros::message_operations::Printer<{name}>::stream(os, "", message);'
    yield "    return os;"
    yield "}"
    yield ""


def _visitor(name: str, kind: str, argument: str, calls: Iterable[str]) -> Iterator[str]:
    body = [f"        {argument}.{call};" for call in calls]
    yield f"    template <class {kind}, class Message>"
    yield f"    static void {name}({kind} &{argument if body else ''}, Message &{'message' if body else ''})"
    yield "    {"
    yield from body
    yield "    }"


def _literal(text: str) -> list[str]:
    """Return the statement that returns a text, with a literal for each of its lines."""
    pieces = [
        line[start : start + _LONGEST_LITERAL]
        for line in text.splitlines(keepends=True) or [""]
        for start in range(0, len(line), _LONGEST_LITERAL) or [0]
    ]
    lines = [f"            {_quoted(piece)}" for piece in pieces]
    return ["        return", *lines[:-1], lines[-1] + ";"]


def _quoted(text: str) -> str:
    """Return a text as a literal, its bytes as UTF-8."""
    return '"' + "".join(map(_escaped, text.encode())) + '"'


def _escaped(byte: int) -> str:
    letter = chr(byte)
    if letter == "\n":
        return "\\n"
    if letter in '"\\':
        return "\\" + letter
    return letter if 32 <= byte < 127 else f"\\{byte:03o}"


def _number(constant: Constant) -> str:
    """Return a constant's value in C++."""
    if constant.type == "bool":
        return "1" if constant.value else "0"
    if constant.type in ("float32", "float64"):
        return _float(float(constant.value), constant.type)
    if constant.value == -(1 << 63):
        return "-9223372036854775807LL - 1"
    return f"{constant.value}{'ULL' if constant.type == 'uint64' else 'LL'}"


def _float(value: float, kind: str) -> str:
    cpp = _NUMBERS[kind]
    if value != value:
        return f"std::numeric_limits<{cpp}>::quiet_NaN()"
    if value in (float("inf"), float("-inf")):
        return f"{'-' if value < 0 else ''}std::numeric_limits<{cpp}>::infinity()"
    return repr(value) + ("f" if kind == "float32" else "")


def _bool(value: bool) -> str:
    return "true" if value else "false"
