"""Source text of `serialize` and `deserialize`; part of genpy.generator.

The functions are generators of lines. Fields are named from a *context*: "self.", "val0." or "" in front of them.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import Any

from genmsg import MsgContext, MsgGenerationException, MsgSpec
from genmsg.msgs import parse_type

from ._expressions import (
    compute_constructor,
    compute_pkg_type,
    compute_post_deserialize,
    flatten,
    get_registered_ex,
    is_special,
    make_python_safe,
)
from .base import is_simple
from .generate_numpy import NUMPY_DTYPE, pack_numpy, unpack_numpy
from .generate_struct import (
    compute_struct_pattern,
    int32_pack,
    int32_unpack,
    pack,
    pack2,
    reduce_pattern,
    unpack,
    unpack3,
)

INDENT = "  "
_LONGEST_PATTERN = 255  # arguments in a call of generated code

_contexts = [""]
_variables = [0]

Source = Iterator[str]


def next_var() -> str:
    """Return a name for a local variable that was not used yet."""
    _variables[0] += 1
    return f"_v{_variables[0]}"


def reset_var() -> None:
    """Begin with the first name again."""
    _variables[0] = 0


def push_context(context: str) -> None:
    """Put something else in front of fields."""
    _contexts.append(context)


def pop_context() -> None:
    """Restore the previous prefix of fields."""
    _contexts.pop()


def len_serializer_generator(var: str, is_string: bool, serialize: bool) -> Source:
    """Yield code for the length of an array. A string's length is written together with the string."""
    if not serialize:
        yield "start = end"
        yield "end += 4"
        yield int32_unpack("length", "str[start:end]")
        return
    yield f"length = len({var})"
    if not is_string:
        yield int32_pack("length")


def string_serializer_generator(package: str, type_: str, name: str, serialize: bool) -> Source:
    """Return a string, or an array of uint8."""
    base, _, length = parse_type(type_)
    octets = base in ("uint8", "char")
    var = _contexts[-1] + name
    if serialize and _contexts[-1]:
        yield f"_x = {var}"
        var = "_x"
    if not octets or length is None:
        yield from len_serializer_generator(var, True, serialize)
    if not serialize:
        yield from _read_string(var, octets, length)
    elif octets:
        yield from _write_octets(var, length)
    else:
        yield f"if python3 or type({var}) == unicode:"
        yield f"{INDENT}{var} = {var}.encode('utf-8')"
        yield f"{INDENT}length = len({var})"
        yield pack2("'<I%ss'%length", f"length, {var}")


def _write_octets(var: str, length: int | None) -> Source:
    yield "# - if encoded as a list instead, serialize as bytes instead of string"
    yield f"if type({var}) in [list, tuple]:"
    yield INDENT + (pack2("'<I%sB'%length", f"length, *{var}") if length is None else pack(f"{length}B", f"*{var}"))
    yield "else:"
    yield INDENT + (pack2("'<I%ss'%length", f"length, {var}") if length is None else pack(f"{length}s", var))


def _read_string(var: str, octets: bool, length: int | None) -> Source:
    yield "start = end"
    yield f"end += {'length' if length is None else length}"
    if octets or length is not None:
        yield f"{var} = str[start:end]"
        return
    yield "if python3:"
    yield f"{INDENT}{var} = str[start:end].decode('utf-8', 'rosmsg')"
    yield "else:"
    yield f"{INDENT}{var} = str[start:end]"


def array_serializer_generator(
    msg_context: MsgContext, package: str, type_: str, name: str, serialize: bool, is_numpy: bool
) -> Source:
    """Return an array.

    Raises:
        MsgGenerationException: the type is none.
    """
    base, is_array, length = parse_type(type_)
    if not is_array:
        raise MsgGenerationException(f"Invalid array spec: {type_}")
    if base in ("char", "uint8"):
        yield from string_serializer_generator(package, type_, name, serialize)
        return
    var = _contexts[-1] + name
    if length is None:
        yield from len_serializer_generator(var, False, serialize)
    if not is_simple(base):
        yield from _items(msg_context, package, type_, var, serialize, is_numpy)
    elif serialize:
        yield from _write_numbers(var, base, length, is_numpy)
    else:
        yield from _read_numbers(var, base, length, is_numpy)


def _write_numbers(var: str, base: str, length: int | None, is_numpy: bool) -> Source:
    code = compute_struct_pattern([base])
    if length is None:
        yield f"pattern = '<%s{code}'%length"
    if is_numpy:
        yield pack_numpy(var)
    else:
        yield pack2("pattern", f"*{var}") if length is None else pack(f"{length}{code}", f"*{var}")


def _read_numbers(var: str, base: str, length: int | None, is_numpy: bool) -> Source:
    code = compute_struct_pattern([base])
    if length is None:
        yield f"pattern = '<%s{code}'%length"
    yield "start = end"
    if length is None:
        yield "s = struct.Struct(pattern)"
    yield f"end += {'s.size' if length is None else struct.calcsize(f'<{length}{code}')}"
    if is_numpy:
        yield unpack_numpy(var, "length" if length is None else length, NUMPY_DTYPE[base], "str[start:end]")
    elif length is None:
        yield unpack3(var, "s", "str[start:end]")
    else:
        yield unpack(var, f"{length}{code}", "str[start:end]")
    if base == "bool":
        yield f"{var} = list(map(bool, {var}))"


def _items(msg_context: MsgContext, package: str, type_: str, var: str, serialize: bool, is_numpy: bool) -> Source:
    """Return an array of strings or messages."""
    base, _, length = parse_type(type_)
    item = f"val{len(_contexts) - 1}"
    push_context("" if base == "string" else f"{item}.")
    if base == "string":
        inner = string_serializer_generator(package, base, item, serialize)
    else:
        spec = make_python_safe(get_registered_ex(msg_context, base))
        inner = serializer_generator(msg_context, spec, serialize, is_numpy)
    if serialize:
        if length is not None:
            text = "Expecting %s items but found %s when writing '%s'"
            yield f"if len({var}) != {length}:"
            yield f"{INDENT}self._check_types(ValueError(\"{text}\" % ({length}, len({var}), '{var}')))"
        yield f"for {item} in {var}:"
    else:
        yield f"{var} = []"
        yield f"for i in range(0, {'length' if length is None else length}):"
        if base != "string":
            yield f"{INDENT}{item} = {compute_constructor(msg_context, package, base)}"
    yield from (INDENT + line for line in inner)
    if not serialize:
        yield f"{INDENT}{var}.append({item})"
    pop_context()


def complex_serializer_generator(
    msg_context: MsgContext, package: str, type_: str, name: str, serialize: bool, is_numpy: bool
) -> Source:
    """Yield code for a field whose type is not simple.

    Raises:
        MsgGenerationException: its type is unknown.
    """
    if parse_type(type_)[1]:
        yield from array_serializer_generator(msg_context, package, type_, name, serialize, is_numpy)
        return
    if type_ == "string":
        yield from string_serializer_generator(package, type_, name, serialize)
        return
    full_name = type_ if is_special(type_) else "/".join(compute_pkg_type(package, type_))
    if not msg_context.is_registered(full_name):
        raise MsgGenerationException(f"Unknown type: {full_name}. Package context is {package}")
    var = next_var()
    yield f"{var} = {_contexts[-1]}{name}"
    push_context(f"{var}.")
    spec = make_python_safe(get_registered_ex(msg_context, full_name))
    yield from serializer_generator(msg_context, spec, serialize, is_numpy)
    pop_context()


def simple_serializer_generator(
    msg_context: MsgContext, spec: MsgSpec, start: int, end: int, serialize: bool
) -> Source:
    """Neighbouring fields of simple types, at once."""
    context, names = _contexts[-1], spec.names[start:end]
    prefix = context
    if len(names) > 1 and context.endswith("."):
        yield f"_x = {context[:-1]}"
        prefix = "_x."
    variables = ", ".join(prefix + name for name in names)
    if serialize and len(names) == 1 and context.endswith("."):
        yield f"_x = {variables}"
        variables = "_x"
    pattern = compute_struct_pattern(spec.types[start:end]) or ""
    if serialize:
        yield pack(pattern, variables)
        return
    yield "start = end"
    yield f"end += {struct.calcsize('<' + reduce_pattern(pattern))}"
    yield unpack(f"({variables},)", pattern, "str[start:end]")
    for kind, name in zip(spec.types[start:end], names, strict=True):
        if kind == "bool":
            yield f"{context}{name} = bool({context}{name})"


def serializer_generator(msg_context: MsgContext, spec: Any, serialize: bool, is_numpy: bool) -> Source:
    """Yield code for all fields of a message.

    Raises:
        MsgGenerationException: the spec is missing, or a field's type is unknown.
    """
    if spec is None:
        raise MsgGenerationException("spec is none")
    if serialize and not spec.names:
        yield "pass"
    first = 0
    for at, (kind, name) in enumerate(spec.fields()):
        if not is_simple(kind):
            yield from _simple_fields(msg_context, spec, first, at, serialize)
            yield from complex_serializer_generator(msg_context, spec.package, kind, name, serialize, is_numpy)
            first = at + 1
    yield from _simple_fields(msg_context, spec, first, len(spec.names), serialize)


def _simple_fields(msg_context: MsgContext, spec: MsgSpec, first: int, last: int, serialize: bool) -> Source:
    for start in range(first, last, _LONGEST_PATTERN):
        end = min(start + _LONGEST_PATTERN, last)
        yield from simple_serializer_generator(msg_context, spec, start, end, serialize)


def serialize_fn_generator(msg_context: MsgContext, spec: MsgSpec, is_numpy: bool = False) -> Source:
    """Body of `serialize`, or of `serialize_numpy`."""
    yield "try:"
    yield from _fields_of_self(msg_context, spec, True, is_numpy)
    found = "(type({0}), str({0}), str(locals().get('_x', self)))"
    for error, raised, var in (("struct.error", "struct.error", "se"), ("TypeError", "ValueError", "te")):
        text = f"\"%s: '%s' when writing '%s'\" % {found.format(var)}"
        yield f"except {error} as {var}: self._check_types({raised}({text}))"


def deserialize_fn_generator(msg_context: MsgContext, spec: MsgSpec, is_numpy: bool = False) -> Source:
    """Body of `deserialize`, or of `deserialize_numpy`."""
    yield "if python3:"
    yield f'{INDENT}codecs.lookup_error("rosmsg").msg_type = self._type'
    yield "try:"
    for kind, name in spec.fields():
        if msg_context.is_registered(kind):
            yield f"{INDENT}if self.{name} is None:"
            yield f"{INDENT * 2}self.{name} = {compute_constructor(msg_context, spec.package, kind)}"
    yield f"{INDENT}end = 0"
    yield from _fields_of_self(msg_context, spec, False, is_numpy)
    for kind, name in spec.fields():
        line = compute_post_deserialize(kind, f"self.{name}")
        if line:
            yield INDENT + line
    yield f"{INDENT}return self"
    yield "except struct.error as e:"
    yield f"{INDENT}raise genpy.DeserializationError(e)  # most likely buffer underfill"


def _fields_of_self(msg_context: MsgContext, spec: MsgSpec, serialize: bool, is_numpy: bool) -> Source:
    push_context("self.")
    flat = make_python_safe(flatten(msg_context, spec))
    yield from (INDENT + line for line in serializer_generator(msg_context, flat, serialize, is_numpy))
    pop_context()
