"""The layout of a cFS mission tree: its folder of definitions, its processors, and the folders of its modules.

A mission tree has a folder NAME_defs with a file targets.cmake, and applications and libraries in `apps` and `libs`.
A tree that was only cloned may have its definitions still in `cfe/cmake/sample_defs`, as NASA delivers them. Modules
are git submodules in most trees, and a submodule that was never fetched is an empty folder.
"""

from __future__ import annotations

import os
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from cfepy.extra.c.toolchain.git_submodules import absent_submodule
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError

TARGETS = "targets.cmake"
DEFINITIONS = "*_defs"
DELIVERED = "cfe/cmake/sample_defs"
SEARCHED = ("apps", "libs", "psp/fsw/modules", "cfe/modules")
"""Folders in which cFS looks for modules."""
_SUFFIX = "_defs"


@dataclass(frozen=True, slots=True)
class TreeLayout:
    """The places of a tree.

    Attributes:
        tree: its folder.
        definitions: its folder of definitions.
        searched: the folders that have its modules; the folders of the user come first.
    """

    tree: Path
    definitions: Path
    searched: tuple[str, ...] = SEARCHED

    @property
    def config_name(self) -> str:
        """The mission's name in file names, such as "sample" of sample_defs."""
        return self.definitions.name.removesuffix(_SUFFIX)

    def absent_submodule(self, folder: Path) -> str:
        """Return the URL of a git submodule that was not fetched; empty if the folder is not one."""
        return absent_submodule(self.tree, folder)


def is_tree(folder: Path, definitions: str | Path | None = None) -> bool:
    """Return True if a folder is a mission tree.

    Args:
        folder: the folder.
        definitions: a folder of definitions that may be elsewhere. With a targets.cmake, it makes a folder with
            `apps` a tree.
    """
    if _definitions_in(folder):
        return True
    return definitions is not None and (Path(definitions) / TARGETS).is_file() and (folder / SEARCHED[0]).is_dir()


def find_layout(tree: Path, definitions: str | Path | None = None, modules: Sequence[str] = ()) -> TreeLayout:
    """Find the places of a tree.

    Args:
        tree: its folder.
        definitions: its folder of definitions, as a path or as a name in the tree; None for the only one.
        modules: more folders with modules, searched before the tree's own, as cFS does with CFS_APP_PATH.

    Raises:
        UsageError: it has no such folder, or several and none was chosen.
    """
    for each in modules:
        if not Path(each).is_dir():
            raise UsageError("folder not found", file=each, field="--modules")
    found = _definitions_in(tree)
    if definitions is not None:
        chosen = next((each for each in (Path(definitions), tree / definitions) if (each / TARGETS).is_file()), None)
        if chosen is None:
            names = [each.name for each in found]
            hint = did_you_mean(str(definitions), names) or (f"; the tree has {', '.join(names)}" if names else "")
            raise UsageError(f"folder of definitions with a {TARGETS} not found{hint}", file=definitions)
    elif not found:
        raise UsageError(f"is not a cFS mission tree: {DEFINITIONS}/{TARGETS} is missing", file=tree)
    elif len(found) > 1:
        several = " ".join(each.name for each in found)
        raise UsageError(f"has several folders of definitions: {several}; choose one with --defs", file=tree)
    else:
        chosen = found[0]
    searched = (*(os.path.abspath(each) for each in modules), *SEARCHED)
    return TreeLayout(Path(os.path.abspath(tree)), Path(os.path.abspath(chosen)), searched)


def tree_above(folder: Path) -> Path | None:
    """Return the mission tree that a folder of an application is in; None if it is in none."""
    for above in list(folder.absolute().parents)[:4]:
        if _definitions_in(above):
            return above
    return None


def _definitions_in(tree: Path) -> list[Path]:
    found = sorted(each for each in tree.glob(DEFINITIONS) if (each / TARGETS).is_file())
    if not found and (tree / DELIVERED / TARGETS).is_file():
        return [tree / DELIVERED]
    return found
