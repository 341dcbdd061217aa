"""Names that a node uses and that nothing defines, or that end it, as its object files have them before the flight."""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator
from functools import cache
from pathlib import Path
from typing import NamedTuple

from cfepy.extra.c import function_names, refusal_of

ASK = ("-Wl,-z,defs", "-Wl,--warn-unresolved-symbols")
"""Flags of the linker that make it report undefined names, and link nevertheless."""
_SAID = re.compile(
    r"(?:\S+: )?(?P<file>[^:\n]+):(?:(?P<line>\d+)|\([^)\n]*\)): (?:warning: )?undefined reference to `(?P<name>.+)'"
)
_WANTED = re.compile(r"^ +U (\w+)(?:\t([^\t\n]*?):(\d+|\?))?$", re.MULTILINE)
_PROVIDED = re.compile(
    r"(?:(?:vtable|typeinfo|typeinfo name|VTT|guard variable|non-virtual thunk) (?:for|to) )?"
    r"(?:ros|roscfe|tf|tf2|tf2_ros|actionlib|XmlRpc|message_filters|nodelet|pluginlib|class_loader|dynamic_reconfigure"
    r"|diagnostic_updater|interactive_markers|laser_geometry|topic_tools|angles|bond|sensor_msgs)::"
    r"|roscfe_\w+$"  # std::cout and its kin without <iostream>
)
"""Names of the interface library. It is not linked for a check, and defines all that its headers declare."""


class UndefinedName(NamedTuple):
    """A use of a name that nothing defines.

    Attributes:
        file: the source, as the linker names it; empty if it does not know it.
        line: of the use; 0 if it is not known.
        name: the name, as in C++.
    """

    file: str
    line: int
    name: str


def undefined_names(said: str, with_library: bool) -> list[UndefinedName]:
    """Return the undefined names in the linker's output, each with its first use. cFE's and OSAL's are left out.

    Args:
        said: the output.
        with_library: whether the interface library was linked.
    """
    found: dict[str, UndefinedName] = {}
    for each in _uses(said.splitlines()):
        known = each.name in _of_cfe() or (not with_library and _PROVIDED.match(each.name))
        if not known:
            found.setdefault(each.name, each)
    return list(found.values())


def ending_calls(said: str, replaced: Iterable[str]) -> list[tuple[UndefinedName, str]]:
    """Return calls of functions of the host that end a node, each with the reason.

    Args:
        said: output of `nm -u -l` for its object files.
        replaced: functions that the interface library has in place of the host's.
    """
    found = []
    for name, file, line in _WANTED.findall(said):
        reason = None if name in replaced else refusal_of(name)
        if reason is not None:
            found.append((UndefinedName(file, int(line) if line.isdigit() else 0, name), reason))
    return found


def _uses(lines: Iterable[str]) -> Iterator[UndefinedName]:
    for line in lines:
        match = _SAID.fullmatch(line)
        if match is not None:
            is_source = Path(match["file"]).suffix != ".o"
            yield UndefinedName(match["file"] if is_source else "", int(match["line"] or 0), match["name"])


@cache
def _of_cfe() -> frozenset[str]:
    return frozenset(function_names())
