"""Reads definitions and their dependencies from texts and files into a `MsgContext`.

A search path is a dict: folders with .msg (or .srv) files by package name.
"""

from __future__ import annotations

import ast
import os
from typing import Any

from ._msg_context import MsgContext
from .base import COMMENTCHAR, CONSTCHAR, EXT_MSG, EXT_SRV, IODELIM, SEP, InvalidMsgSpec, log
from .msgs import (
    HEADER,
    HEADER_FULL_NAME,
    Constant,
    Field,
    MsgSpec,
    bare_msg_type,
    is_builtin,
    is_valid_constant_type,
    is_valid_msg_field_name,
    is_valid_msg_type,
    resolve_type,
)
from .names import package_resource_name
from .srvs import SrvSpec

__all__ = [
    "Field",
    "InvalidMsgSpec",
    "MsgContext",
    "MsgNotFound",
    "convert_constant_value",
    "get_msg_file",
    "get_srv_file",
    "is_valid_msg_field_name",
    "load_depends",
    "load_msg_by_type",
    "load_msg_depends",
    "load_msg_from_file",
    "load_msg_from_string",
    "load_srv_by_type",
    "load_srv_from_file",
    "load_srv_from_string",
]

TIME, DURATION = "time", "duration"
TIME_MSG, DURATION_MSG = "uint32 secs\nuint32 nsecs", "int32 secs\nint32 nsecs"

_SearchPath = dict[str, list[str]]

_BITS = {"char": 8, "byte": 8} | {f"{sign}int{bits}": bits for sign in ("", "u") for bits in (8, 16, 32, 64)}


class MsgNotFound(Exception):  # ROS's name
    """A definition is not on the search path."""

    def __init__(
        self,
        message: str,
        base_type: str | None = None,
        package: str | None = None,
        search_path: Any = None,
    ) -> None:
        super().__init__(message)
        self.base_type, self.package, self.search_path = base_type, package, search_path


def get_msg_file(package: str, base_type: str, search_path: _SearchPath, ext: str = EXT_MSG) -> str:
    """Return the path of a definition.

    Raises:
        MsgNotFound: the package or the file does not exist.
        ValueError: the search path is not a dict.
    """
    _check_path(search_path)
    if package not in search_path:
        problem = f"Cannot locate message [{base_type}]: unknown package [{package}] on search path [{search_path}]"
        raise MsgNotFound(problem, base_type, package, search_path)
    for folder in search_path[package]:
        path = os.path.join(folder, base_type + ext)
        if os.path.isfile(path):
            return path
    problem = f"Cannot locate message [{base_type}] in package [{package}] with paths [{search_path[package]}]"
    raise MsgNotFound(problem, base_type, package, search_path)


def get_srv_file(package: str, base_type: str, search_path: _SearchPath) -> str:
    """Return the path of a service's definition; see `get_msg_file`."""
    return get_msg_file(package, base_type, search_path, EXT_SRV)


def load_msg_by_type(msg_context: MsgContext, msg_type: str, search_path: _SearchPath) -> MsgSpec:
    """Read the definition of a type from the search path, and make it known.

    Raises:
        MsgNotFound: it is not there.
        InvalidMsgSpec: it has a mistake.
    """
    _check_path(search_path)
    full_name = HEADER_FULL_NAME if msg_type == HEADER else msg_type
    path = get_msg_file(*package_resource_name(full_name), search_path)
    spec = load_msg_from_file(msg_context, path, full_name)
    msg_context.set_file(full_name, path)
    return spec


def load_srv_by_type(msg_context: MsgContext, srv_type: str, search_path: _SearchPath) -> SrvSpec:
    """Read the definition of a service from the search path; see `load_msg_by_type`."""
    _check_path(search_path)
    return load_srv_from_file(msg_context, get_srv_file(*package_resource_name(srv_type), search_path), srv_type)


def convert_constant_value(field_type: str, val: str) -> Any:
    """Convert the text of a constant to its value.

    Raises:
        InvalidMsgSpec: it does not fit into its type, or the type has no constants.
        ValueError: it is not of its type.
    """
    if field_type in ("float32", "float64"):
        return float(val)
    if field_type == "string":
        return val.strip()
    if field_type == "bool":
        return bool(ast.literal_eval(val))
    if field_type not in _BITS:
        raise InvalidMsgSpec(f"invalid constant type: [{field_type}]")
    number, bits = int(val), _BITS[field_type]
    unsigned = field_type[0] == "u" or field_type == "char"
    low, high = (0, 1 << bits) if unsigned else (-(1 << bits - 1), 1 << bits - 1)
    if not low <= number < high:
        raise InvalidMsgSpec(f"cannot coerce [{number}] to {field_type} (out of bounds)")
    return number


def load_msg_from_string(msg_context: MsgContext, text: str, full_name: str) -> MsgSpec:
    """Read a definition from its text, and make it known.

    Raises:
        InvalidMsgSpec: it has a mistake.
    """
    log("load_msg_from_string", full_name)
    package, _ = package_resource_name(full_name)
    fields: list[tuple[str, str]] = []
    constants: list[Constant] = []
    for line in text.split("\n"):
        clean = _without_comment(line)
        if CONSTCHAR in clean:
            constants.append(_load_constant_line(line))
        elif clean:
            fields.append(_load_field_line(line, package))
    spec = MsgSpec([kind for kind, _ in fields], [name for _, name in fields], constants, text, full_name, package)
    msg_context.register(full_name, spec)
    return spec


def load_msg_from_file(msg_context: MsgContext, file_path: str, full_name: str) -> MsgSpec:
    """Read a definition from a file, and register it.

    Raises:
        InvalidMsgSpec: it has a mistake; the text names the file.
    """
    try:
        return load_msg_from_string(msg_context, _contents(file_path), full_name)
    except InvalidMsgSpec as error:
        raise InvalidMsgSpec(f"{file_path}: {error}") from None


def load_srv_from_string(msg_context: MsgContext, text: str, full_name: str) -> SrvSpec:
    """Read the definition of a service from its text, and make its request and response known.

    Raises:
        InvalidMsgSpec: it has a mistake.
    """
    parts: tuple[list[str], list[str]] = ([], [])
    behind = False
    for line in text.split("\n"):
        if line.startswith(IODELIM):
            behind = True
        else:
            parts[behind].append(line + "\n")
    request, response = (
        load_msg_from_string(msg_context, "".join(lines), full_name + ending)
        for lines, ending in zip(parts, ("Request", "Response"), strict=True)
    )
    return SrvSpec(request, response, text, full_name)


def load_srv_from_file(msg_context: MsgContext, file_path: str, full_name: str) -> SrvSpec:
    """Read the definition of a service from a file; see `load_srv_from_string`."""
    spec = load_srv_from_string(msg_context, _contents(file_path), full_name)
    for part in (spec.request, spec.response):
        msg_context.set_file(part.full_name, file_path)
    return spec


def load_msg_depends(msg_context: MsgContext, spec: MsgSpec, search_path: _SearchPath) -> list[str]:
    """Make the types known that a definition needs.

    Returns:
        the types of its fields that do not belong to the language.

    Raises:
        MsgNotFound: one is not there.
    """
    needed = []
    for kind in spec.types:
        full_name = resolve_type(bare_msg_type(kind), spec.package)
        if is_builtin(full_name):
            continue
        if msg_context.is_registered(full_name):
            inner = msg_context.get_registered(full_name)
        else:
            inner = load_msg_by_type(msg_context, full_name, search_path)
        needed.append(full_name)
        if msg_context.get_depends(full_name) is None:
            load_msg_depends(msg_context, inner, search_path)
    assert spec.full_name, "MsgSpec must have a properly set full name"
    msg_context.set_depends(spec.full_name, list(needed))
    return needed


def load_depends(msg_context: MsgContext, spec: Any, msg_search_path: _SearchPath) -> list[str]:
    """Load dependencies as `load_msg_depends` does, also for a service.

    Raises:
        ValueError: `spec` is neither.
    """
    if isinstance(spec, MsgSpec):
        return load_msg_depends(msg_context, spec, msg_search_path)
    if isinstance(spec, SrvSpec):
        parts = (spec.request, spec.response)
        return [name for part in parts for name in load_msg_depends(msg_context, part, msg_search_path)]
    raise ValueError("spec does not appear to be a message or service")


def _check_path(search_path: Any) -> None:
    if not isinstance(search_path, dict):
        raise ValueError("search_path must be a dictionary of {namespace: dirpath}")


def _contents(path: str) -> str:
    with open(path, encoding="utf-8") as file:
        return file.read()


def _without_comment(line: str) -> str:
    return line.split(COMMENTCHAR)[0].strip()


def _load_constant_line(orig_line: str) -> Constant:
    clean = _without_comment(orig_line)
    kind = clean.split(" ")[0]
    if not is_valid_constant_type(kind):
        raise InvalidMsgSpec(f"{kind} is not a legal constant type")
    if kind == "string":
        declared, _, val = orig_line.partition(CONSTCHAR)  # all that stands behind is the string
    else:
        declared, *values = clean.split(CONSTCHAR)
        if len(values) != 1:
            raise InvalidMsgSpec(f"Invalid constant declaration: {orig_line}")
        (val,) = values
    try:
        converted = convert_constant_value(kind, val.strip() if kind != "string" else val)
    except Exception as error:
        raise InvalidMsgSpec(f"Invalid constant value: {error}") from None
    return Constant(kind, declared.strip().partition(" ")[2], converted, val.strip())


def _load_field_line(orig_line: str, package_context: str) -> tuple[str, str]:
    words = _without_comment(orig_line).split()
    if len(words) != 2:
        raise InvalidMsgSpec(f"Invalid declaration: {orig_line}")
    kind, name = words
    if not is_valid_msg_field_name(name):
        raise InvalidMsgSpec(f"{name} is not a legal message field name")
    if not is_valid_msg_type(kind):
        raise InvalidMsgSpec(f"{kind} is not a legal message field type")
    if kind == HEADER:
        return HEADER_FULL_NAME, name
    if package_context and SEP not in kind and not is_builtin(bare_msg_type(kind)):
        return f"{package_context}{SEP}{kind}", name
    return kind, name
