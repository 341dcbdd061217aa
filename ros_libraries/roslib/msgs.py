"""roslib.msgs: parses message definitions (`MsgSpec`), by name or from a text. It uses genmsg."""

from __future__ import annotations

import os
from typing import Any

import rosmsg
from genmsg import InvalidMsgSpec, MsgContext
from genmsg.msg_loader import convert_constant_value, load_msg_from_string
from genmsg.msgs import (
    BUILTIN_TYPES,
    DURATION,
    HEADER,
    PRIMITIVE_TYPES,
    TIME,
    Constant,
    Field,
    bare_msg_type,
    is_builtin,
    is_header_type,
    is_valid_constant_type,
    is_valid_msg_field_name,
    is_valid_msg_type,
    resolve_type,
)
from genmsg.msgs import MsgSpec as _MsgSpec
from genmsg.msgs import parse_type as _parse_type

from roslib.names import package_resource_name, resource_name
from roslib.packages import resource_file

__all__ = [
    "BUILTIN_TYPES",
    "DURATION",
    "EXT",
    "HEADER",
    "PRIMITIVE_TYPES",
    "RESERVED_TYPES",
    "SEP",
    "TIME",
    "Constant",
    "Field",
    "MsgSpec",
    "MsgSpecException",
    "base_msg_type",
    "get_pkg_msg_specs",
    "get_registered",
    "is_builtin",
    "is_header_type",
    "is_registered",
    "is_valid_constant_type",
    "is_valid_msg_field_name",
    "is_valid_msg_type",
    "is_verbose",
    "list_msg_types",
    "load_by_type",
    "load_from_file",
    "load_from_string",
    "msg_file",
    "parse_type",
    "register",
    "resolve_type",
    "set_verbose",
]

SEP = "/"
EXT = ".msg"
COMMENTCHAR = "#"
CONSTCHAR = "="
RESERVED_TYPES = [*BUILTIN_TYPES, HEADER]
VERBOSE = False

MsgSpecException = InvalidMsgSpec
base_msg_type = bare_msg_type
_convert_val = convert_constant_value
_UNNAMED = "Unnamed"


def set_verbose(v: bool) -> None:
    """Set whether to print the files that are read. Only `is_verbose` uses the value."""
    global VERBOSE
    VERBOSE = v


def is_verbose() -> bool:
    """Return the last value given to `set_verbose`."""
    return VERBOSE


def parse_type(type_: str) -> tuple[str, bool, int | None]:
    """Return the base type, whether it is an array, and the length of a fixed array.

    Raises:
        MsgSpecException: not a type.
    """
    try:
        return _parse_type(type_)
    except ValueError as error:
        raise MsgSpecException(str(error)) from None


class MsgSpec(_MsgSpec):
    """A definition; see genmsg.MsgSpec, which has the last two arguments in the other order.

    Args:
        types: types of the fields.
        names: names of the fields.
        constants: its constants.
        text: its text.
        full_name: with the package.
        short_name: without it.
        package: its package.
    """

    def __init__(
        self,
        types: list[str],
        names: list[str],
        constants: list[Constant],
        text: str,
        full_name: str = "",
        short_name: str = "",
        package: str = "",
    ) -> None:
        super().__init__(types, names, constants, text, full_name, package, short_name)
        self.header_present = self.names[:1] == ["header"] and is_header_type(self.types[0])


# -- definitions by name ---------------------------------------------------------------------------------------------

REGISTERED_TYPES: dict[str, Any] = {}


def register(msg_type_name: str, msg_spec: Any) -> None:
    """Make a definition known under a full name."""
    REGISTERED_TYPES[msg_type_name] = msg_spec


def is_registered(msg_type_name: str) -> bool:
    """Return whether a definition is known under a full name."""
    return msg_type_name in REGISTERED_TYPES


def get_registered(msg_type_name: str, default_package: str | None = None) -> Any:
    """Return a definition by name. An unregistered one is looked up.

    Raises:
        KeyError: there is no such message.
    """
    name = resolve_type(msg_type_name, default_package or "")
    if name not in REGISTERED_TYPES:
        try:
            register(*load_by_type(name))
        except MsgSpecException:
            raise KeyError(msg_type_name) from None
    return REGISTERED_TYPES[name]


def msg_file(package: str, type_: str) -> str:
    """Return the path of a definition, even if it does not exist.

    Raises:
        InvalidROSPkgException: there is no such package.
    """
    return resource_file(package, "msg", type_ + EXT)


def list_msg_types(package: str, include_depends: bool) -> list[str]:
    """Return the names of the messages of a package; with `include_depends`, also those of its dependencies."""
    import rospkg

    found = [name.partition(SEP)[2] for name in rosmsg.list_msgs(package)]
    depends = rospkg.RosPack().get_depends(package, implicit=False) if include_depends else []
    return found + [name for each in depends for name in rosmsg.list_msgs(each)]


def get_pkg_msg_specs(package: str) -> tuple[list[tuple[str, MsgSpec]], list[str]]:
    """Return names and definitions of a package's messages, and the names of unreadable ones."""
    found: list[tuple[str, MsgSpec]] = []
    failed: list[str] = []
    for name in list_msg_types(package, False):
        try:
            found.append(load_by_type(f"{package}{SEP}{name}"))
        except (MsgSpecException, rosmsg.ROSMsgException):
            failed.append(name)
    return found, failed


def load_by_type(msgtype: str, package_context: str = "") -> tuple[str, MsgSpec]:
    """Return the full name and definition of a message.

    Args:
        msgtype: its name.
        package_context: the package of a name without one.

    Raises:
        MsgSpecException: there is no such message.
    """
    full_name = resolve_type(msgtype, package_context)
    package, name = package_resource_name(full_name)
    try:
        text = rosmsg.get_msg_text(full_name, raw=True)
    except rosmsg.ROSMsgException as error:
        raise MsgSpecException(str(error)) from None
    return full_name, load_from_string(text, package, full_name, name)


def load_from_file(file_path: str, package_context: str = "") -> tuple[str, MsgSpec]:
    """Return the name and definition in a file. The name is a full one if the package is given.

    Args:
        file_path: the file.
        package_context: the package.

    Raises:
        MsgSpecException: a mistake in it.
    """
    short = os.path.basename(file_path).removesuffix(EXT)
    name = resource_name(package_context, short)
    with open(file_path, encoding="utf-8") as file:
        return name, load_from_string(file.read(), package_context, name, short)


def load_from_string(text: str, package_context: str = "", full_name: str = "", short_name: str = "") -> MsgSpec:
    """Return the definition in a text.

    Raises:
        MsgSpecException: a mistake in it.
    """
    name = f"{package_context}{SEP}{short_name or _UNNAMED}"
    found = load_msg_from_string(MsgContext.create_default(), text, name)
    return MsgSpec(found.types, found.names, found.constants, text, full_name, short_name, package_context)
