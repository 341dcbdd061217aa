"""`ParameterGenerator`: a package's cfg/*.cfg scripts describe their parameters with it.

ROS runs such a script at build time and writes C++ and Python from it. Here `generate` keeps the description, and
`cfg_script` makes the module `<package>.cfg.<Name>Config` from it.
"""

from __future__ import annotations

import math
import os
import sys
from collections.abc import Sequence
from typing import Any, ClassVar

from ._parameter_groups import Group, check_name, source_of

# Scripts begin with a star import, and end with sys.exit without an import of their own.
__all__ = [
    "ParameterGenerator",
    "bool_t",
    "check_description",
    "check_name",
    "double_t",
    "int_t",
    "os",
    "str_t",
    "sys",
]

str_t = "str"
bool_t = "bool"
int_t = "int"
double_t = "double"

_TYPES: dict[str, type] = {"str": str, "int": int, "double": float, "bool": bool}
_C_TYPES = {"str": "std::string", "int": "int", "double": "double", "bool": "bool"}
_C_CONSTANTS = {"str": "const char * const", "int": "const int", "double": "const double", "bool": "const bool"}


def check_description(description: str) -> None:
    """Check the text for a constant or an enum.

    Raises:
        Exception: it has quotes.
    """
    if '"' in description or "'" in description:
        raise Exception(f"quotes not allowed in description string `{description}`")


class ParameterGenerator:
    """Collects the parameters, groups and constants of one configuration."""

    generated: ClassVar[dict[str, ParameterGenerator]] = {}
    """Those on which `generate` was called, by configuration name."""

    minval: ClassVar[dict[str, Any]] = {"int": -0x80000000, "double": -math.inf, "str": "", "bool": False}
    maxval: ClassVar[dict[str, Any]] = {"int": 0x7FFFFFFF, "double": math.inf, "str": "", "bool": True}
    defval: ClassVar[dict[str, Any]] = {"int": 0, "double": 0, "str": "", "bool": False}
    """What stands for a limit or default that is not given; ROS has the int 0 for a double as well."""

    Group = Group  # its name in ROS

    def __init__(self) -> None:
        self.constants: list[dict[str, Any]] = []
        self.groups: list[Any] = []
        self.group = self.Group(self, "Default", "", True, 0, 0)

    def const(self, name: str, type: str, value: Any, descr: str) -> dict[str, Any]:
        """A constant, for an enum; it becomes `<Configuration>_<name>` in the generated module.

        Raises:
            TypeError: the value is not of the type.
        """
        made = {"name": name, "type": type, "value": value, "description": descr, **source_of(sys._getframe(1))}
        check_description(descr)
        self.fill_type(made)
        self.check_type(made, "value")
        self.constants.append(made)
        return made

    def enum(self, constants: Sequence[dict[str, Any]], description: str) -> str:
        """Return the `edit_method` of a parameter that takes one of some constants.

        Raises:
            Exception: the constants are of different types.
        """
        if len({each["type"] for each in constants}) != 1:
            raise Exception("Inconsistent types in enum!")
        check_description(description)
        return repr({"enum": constants, "enum_description": description})

    def add(
        self,
        name: str,
        paramtype: str,
        level: int,
        description: str,
        default: Any = None,
        min: Any = None,
        max: Any = None,
        edit_method: str = "",
    ) -> None:
        """Add a parameter to the outermost group; see `Group.add`."""
        self.group.add(name, paramtype, level, description, default, min, max, edit_method)

    def add_group(self, name: str, type: str = "", state: bool = True) -> Any:
        """Add a group to the outermost one; see `Group.add_group`."""
        return self.group.add_group(name, type, state)

    def generate(self, pkgname: str, nodename: str, name: str) -> None:
        """The script is complete: the configuration is called `name`."""
        self.pkgname, self.nodename, self.name, self.msgname = pkgname, nodename, name, f"{name}Config"
        self.generated[name] = self

    def pytype(self, drtype: str) -> Any:
        """Python's type for one of dynamic_reconfigure."""
        return _TYPES[drtype]

    def check_type(self, param: dict[str, Any], field: str) -> None:
        """Check that a value is of its parameter's type. An int for a double becomes a float.

        Raises:
            TypeError: the value has another type.
        """
        value, wanted = param[field], self.pytype(param["type"])
        if type(value) is not wanted and not (wanted is float and type(value) is int):
            raise TypeError(f"'{param['name']}' has type {param['type']}, but {field} is {value!r}")
        param[field] = wanted(value)  # a float, where an int was given

    def fill_type(self, param: dict[str, Any]) -> None:
        """Add the C++ types, which are part of the description."""
        param["ctype"], param["cconsttype"] = _C_TYPES[param["type"]], _C_CONSTANTS[param["type"]]

    def check_type_fill_default(self, param: dict[str, Any], field: str, default: Any) -> None:
        """Put a default in place of None, or check the type."""
        if param[field] is None:
            param[field] = default
        else:
            self.check_type(param, field)
