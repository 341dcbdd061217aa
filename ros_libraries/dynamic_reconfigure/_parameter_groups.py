"""`Group`: parameters that a user sees together, and nested groups; ParameterGenerator.Group in ROS."""

from __future__ import annotations

import re
import sys
from typing import Any

_NAME = re.compile(r"[a-zA-Z][a-zA-Z0-9_]*")


def check_name(name: str) -> None:
    """Check the name of a parameter.

    Raises:
        Exception: it is not made of letters, digits and underscores.
    """
    if not _NAME.fullmatch(name):
        raise Exception(
            f"The name of field '{name}' does not follow the ROS naming conventions, see"
            " http://wiki.ros.org/ROS/Patterns/Conventions"
        )


def source_of(frame: Any) -> dict[str, Any]:
    """Return where a parameter, group or constant was described."""
    return {"srcline": frame.f_lineno, "srcfile": frame.f_code.co_filename}


class Group:
    """One group.

    Args:
        gen: the generator it belongs to.
        name: its name; spaces become underscores.
        type: how it is shown: "", "collapse", "tab", "hide" or "apply".
        state: whether it is open.
        id: its number; 0 is the outermost group.
        parent: number of the enclosing group.
    """

    def __init__(self, gen: Any, name: str, type: str, state: bool, id: int, parent: int) -> None:
        self.name = name.replace(" ", "_")
        self.type, self.state, self.id, self.parent = type, state, id, parent
        self.gen = gen
        self.groups: list[Group] = []
        self.parameters: list[dict[str, Any]] = []
        caller = sys._getframe(1)
        self.srcline, self.srcfile = caller.f_lineno, caller.f_code.co_filename
        gen.groups.append(self)

    def get_group(self, id: int) -> Group:
        """Return the generator's group with a number."""
        found: Group = self.gen.groups[id]
        return found

    def add_group(self, name: str, type: str = "", state: bool = True) -> Group:
        """Add a group inside this one."""
        made = self.gen.Group(self.gen, name, type, state, len(self.gen.groups), self.id)
        self.groups.append(made)
        found: Group = made
        return found

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
        """Add a parameter.

        Args:
            name: letters, digits and underscores.
            paramtype: "int", "double", "str" or "bool".
            level: bits that the server's callback gets when this parameter changes.
            description: for the user.
            default: value; 0, "" or False without one.
            min: lowest value of a number.
            max: highest value of a number.
            edit_method: an enum, see `ParameterGenerator.enum`.

        Raises:
            Exception: a bad name, or limits for a str or bool.
            TypeError: a value of another type.
        """
        if paramtype in ("str", "bool") and (min is not None or max is not None):
            raise Exception(f"Max or min specified for {name}, which is of '{paramtype}' type")
        check_name(name)
        given = {"default": default, "max": max, "min": min}
        made = {"name": name, "type": paramtype, "level": level, "description": description, **given}
        made |= {"edit_method": edit_method, **source_of(sys._getframe(1))}
        self.gen.fill_type(made)
        for field, fallback in (("default", "defval"), ("max", "maxval"), ("min", "minval")):
            self.gen.check_type_fill_default(made, field, getattr(self.gen, fallback)[paramtype])
        self.parameters.append(made)

    def get_parameters(self) -> list[dict[str, Any]]:
        """Return the parameters of this group and of those inside."""
        return [*self.parameters, *(each for group in self.groups for each in group.get_parameters())]

    def get_parents(self) -> list[str]:
        """Return the names of the groups around this one, outermost first, and its own."""
        above = self.get_group(self.parent).get_parents() if self.id else []
        return [*above, self.name]

    def get_field(self) -> str:
        """Return its member in the generated C++ class."""
        return "::".join(each.lower() if each == self.name else each.upper() for each in self.get_parents())

    def get_class(self, parent: bool = False) -> str:
        """Return its class in the generated C++, or the one around that."""
        names = self.get_parents()[:-1] if parent else self.get_parents()
        return "::".join(names).upper()

    def to_dict(self) -> dict[str, Any]:
        """Return the description of the group: `config_description` of the generated module."""
        return {
            "name": self.name,
            "type": self.type,
            "state": self.state,
            "cstate": "true" if self.state else "false",
            "id": self.id,
            "parent": self.parent,
            "parameters": self.parameters,
            "groups": [group.to_dict() for group in self.groups],
            "srcline": self.srcline,
            "srcfile": self.srcfile,
            "class": self.get_class(),
            "parentclass": self.get_class(parent=True),
            "parentname": self.get_group(self.parent).name,
            "field": self.get_field(),
            "upper": self.name.upper(),
            "lower": self.name.lower() if self.id else "groups",
        }
