"""Types as Python source: defaults, constructors and imports; specs made fit for Python. Part of genpy.generator."""

from __future__ import annotations

import keyword
from typing import Any, NamedTuple

import genmsg
from genmsg import MsgContext, MsgGenerationException, MsgSpec
from genmsg.msgs import bare_msg_type, is_builtin, is_header_type, parse_type

from .base import is_simple

_RESERVED = frozenset((*keyword.kwlist, "self"))


class Special(NamedTuple):
    """A type of the language that is an object in Python."""

    constructor: str
    post_deserialize: str | None
    import_str: str

    def get_post_deserialize(self, varname: str) -> str | None:
        """Source to be run after a value was read, or None."""
        return self.post_deserialize % varname if self.post_deserialize else None


_SPECIAL = {
    genmsg.HEADER: Special("std_msgs.msg._Header.Header()", None, "import std_msgs.msg"),
    genmsg.TIME: Special("genpy.Time()", "%s.canon()", "import genpy"),
    genmsg.DURATION: Special("genpy.Duration()", "%s.canon()", "import genpy"),
}


def is_special(type_: str) -> bool:
    """Return whether a type is a header, a time or a duration."""
    return type_ in _SPECIAL


def get_special(type_: str) -> Any:
    """Return the replacement of a special type, or None."""
    return _SPECIAL.get(type_)


def get_registered_ex(msg_context: MsgContext, type_: str) -> MsgSpec:
    """Spec of a type.

    Raises:
        MsgGenerationException: it is not known.
    """
    try:
        spec: MsgSpec = msg_context.get_registered(type_)
    except (KeyError, ValueError):
        problem = f"Unknown type [{type_}]. Please check that the manifest.xml correctly declares dependencies."
        raise MsgGenerationException(problem) from None
    return spec


def default_value(msg_context: MsgContext, field_type: str, default_package: str) -> str | None:
    """Return an expression for the default of a type, or None if the type is unknown."""
    base, is_array, length = parse_type(field_type)
    if not is_array:
        return _default_of_one(msg_context, field_type, default_package)
    if base in ("char", "uint8"):
        return "b''" if length is None else rf"b'\0'*{length}"
    if length is None:
        return "[]"
    item = _default_of_one(msg_context, base, default_package)
    return f"[{item}] * {length}" if is_simple(base) or base == "string" else f"[{item} for _ in range({length})]"


def _default_of_one(msg_context: MsgContext, field_type: str, default_package: str) -> str | None:
    if field_type in ("float32", "float64"):
        return "0."
    if field_type == "bool":
        return "False"
    if field_type == "string":
        return "''"
    return "0" if is_simple(field_type) else compute_constructor(msg_context, default_package, field_type)


def compute_constructor(msg_context: MsgContext, package: str, type_: str) -> str | None:
    """Return an expression that makes a message, or None for an array or an unknown type.

    Args:
        msg_context: the known types.
        package: package of the message that uses the type.
        type_: the type.
    """
    if is_special(type_):
        return str(get_special(type_).constructor)
    if bare_msg_type(type_) != type_:
        return None
    owner, name = compute_pkg_type(package, type_)
    return f"{owner}.msg.{name}()" if msg_context.is_registered(f"{owner}/{name}") else None


def compute_post_deserialize(type_: str, varname: str) -> str | None:
    """Source to be run after a value was read, or None."""
    special = get_special(type_)
    found: str | None = special.get_post_deserialize(varname) if special is not None else None
    return found


def compute_pkg_type(package: str, type_: str) -> tuple[str, str]:
    """(package, name) of a type that is named in a package.

    Raises:
        MsgGenerationException: it has too many parts.
    """
    owner, _, name = type_.rpartition(genmsg.SEP)
    if genmsg.SEP in owner:
        raise MsgGenerationException(f"illegal message type: {type_}")
    return owner or package, name


def compute_import(msg_context: MsgContext, package: str, type_: str) -> list[str]:
    """Return the import statements of a type and of the types inside it."""
    bare = bare_msg_type(type_)
    owner, name = compute_pkg_type(package, bare)
    if is_builtin(bare) or is_header_type(bare):
        return [get_special(name).import_str] if is_special(name) else []
    full_name = f"{owner}/{name}"
    if not msg_context.is_registered(full_name):
        return []
    found = {f"import {owner}.msg": None}
    for inner in msg_context.get_registered(full_name).types:
        assert inner != full_name, f"msg [{full_name}] has circular self-dependencies"
        found.update(dict.fromkeys(compute_import(msg_context, package, inner)))
    return list(found)


def compute_full_text_escaped(msg_context: MsgContext, spec: MsgSpec) -> str:
    """Return the full text, fit for triple quotes."""
    return genmsg.compute_full_text(msg_context, spec).replace('"""', r"\"\"\"")


def flatten(msg_context: MsgContext, msg: MsgSpec) -> MsgSpec:
    """Return a spec with nested messages replaced by their fields, with dotted names. Arrays of messages stay."""
    types: list[str] = []
    names: list[str] = []
    for kind, name in msg.fields():
        if not parse_type(kind)[1] and msg_context.is_registered(kind):
            inner = flatten(msg_context, msg_context.get_registered(kind))
            types += inner.types
            names += [f"{name}.{each}" for each in inner.names]
        else:
            types.append(kind)
            names.append(name)
    return MsgSpec(types, names, msg.constants, msg.text, msg.full_name)


def make_python_safe(spec: MsgSpec) -> MsgSpec:
    """Return a spec in which reserved words end with an underscore."""
    constants = [genmsg.Constant(each.type, _safe(each.name), each.val, each.val_text) for each in spec.constants]
    return MsgSpec(spec.types, [_safe(name) for name in spec.names], constants, spec.text, spec.full_name)


def _safe(name: str) -> str:
    return f"{name}_" if name.rpartition(".")[2] in _RESERVED else name
