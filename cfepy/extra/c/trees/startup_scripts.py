"""The startup script of a tree's processor: a file, a text that the build writes, or one made from the modules."""

from __future__ import annotations

import os
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import NamedTuple

from cfepy.es import CFE_APP, CFE_LIB, StartupEntry, entries
from cfepy.extra.c.trees.tree_model import TreeModel, locate_installed
from cfepy.reading.input_files import read_limited, unreadable
from cfepy.reading.input_limits import STARTUP_BYTES

NAME = "cfe_es_startup.scr"
FIRST_PRIORITY, PRIORITY_STEP, LAST_PRIORITY = 50, 5, 200
STACK_BYTES = 16384
LONGEST_NAME = 19
_APP_ENDS, _LIBRARY_ENDS = ("_appmain", "_main", "_app_main", "appmain"), ("_init", "_libinit", "_lib_init")


class StartupScript(NamedTuple):
    """A startup script.

    Attributes:
        text: its bytes.
        origin: where it comes from, for the report.
        is_made: whether it was made from the modules, with assumed priorities and stack sizes.
    """

    text: bytes
    origin: str
    is_made: bool = False

    @property
    def lines(self) -> list[StartupEntry]:
        """Its valid entries."""
        return entries(self.text)


def find_startup(model: TreeModel, chosen: Path | None = None) -> StartupScript | None:
    """Find the startup script of a tree's processor.

    Args:
        model: the tree.
        chosen: a file that is used in place of the tree's.

    Returns:
        The script; None if the tree has none.

    Raises:
        UsageError: the file cannot be read.
    """
    if chosen is not None:
        return StartupScript(_read(chosen), str(chosen))
    file = model.files.get(NAME) or locate_installed(model.layout.definitions, model.cpu, NAME)
    if file is not None:
        return StartupScript(_read(file), os.path.relpath(file, model.layout.tree))
    for path, text in model.written.items():
        if path.endswith(".scr") and f"/{model.cpu}/" in path:
            return StartupScript(text.encode(), "written by the tree's CMake files")
    return None


def _read(file: Path) -> bytes:
    try:
        return read_limited(file, STARTUP_BYTES)
    except OSError as error:
        raise unreadable(file, error) from None


def made_startup(built: Iterable[tuple[str, Sequence[str], Sequence[str]]]) -> StartupScript:
    """Make a startup script for modules, libraries first.

    Args:
        built: the name of each shared object, its functions, and the full names of its tables. The application must
            have the name that its tables' names begin with.
    """
    libraries, applications = [], []
    for name, functions, tables in built:
        entry = _entry_point(functions, _APP_ENDS)
        if entry:
            owner = next((each.partition(".")[0] for each in tables if "." in each), _cfe_name(name))
            applications.append((name, entry, owner))
        elif init := _entry_point(functions, _LIBRARY_ENDS):
            libraries.append((name, init))
    lines = [f"{CFE_LIB}, {name}, {entry}, {_cfe_name(name)}, 0, 0, 0x0, 0;" for name, entry in libraries]
    for at, (name, entry, owner) in enumerate(applications):
        priority = min(FIRST_PRIORITY + PRIORITY_STEP * at, LAST_PRIORITY)
        lines.append(f"{CFE_APP}, {name}, {entry}, {owner}, {priority}, {STACK_BYTES}, 0x0, 0;")
    text = "\n".join((*lines, "!", "Made by cfepy build: the tree has no startup script. Check priorities and stacks."))
    return StartupScript(text.encode() + b"\n", "made from the modules; priorities and stack sizes are assumed", True)


def _entry_point(functions: Sequence[str], ends: Sequence[str]) -> str:
    """Return the shortest function that ends as entry points do; empty if there is none."""
    found = [each for each in functions if each.lower().endswith(tuple(ends))]
    return min(found, key=lambda each: (len(each), each), default="")


def _cfe_name(name: str) -> str:
    return name.upper()[:LONGEST_NAME]
