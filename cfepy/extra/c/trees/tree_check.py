"""`cfepy check TREE`: the problems of a mission tree that its files show, without a compiler and without CMake."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from cfepy.extra.c.toolchain.cfe6 import advised_option, removed_names, used_names
from cfepy.extra.c.toolchain.source_files import Sources, own_headers
from cfepy.extra.c.trees.startup_scripts import find_startup
from cfepy.extra.c.trees.tree_layout import TARGETS, find_layout, is_tree
from cfepy.extra.c.trees.tree_model import module_folders
from cfepy.extra.c.trees.tree_reader import read_tree
from cfepy.pilot import MissionProblem
from cfepy.reading.resources import shipped


def check_tree(folder: Path) -> list[MissionProblem] | None:
    """Find the problems of a mission tree, for its first processor.

    Args:
        folder: the tree.

    Returns:
        The problems; None if the folder is not a tree.

    Raises:
        UsageError: its files cannot be read.
    """
    if not is_tree(folder):
        return None
    layout = find_layout(folder)
    targets = layout.definitions / TARGETS
    model = read_tree(layout)
    found = []
    for each in model.modules:
        if each.sources is None:
            stands_in = (shipped("apps") / each.name).is_dir()
            text = f"{each.name} {each.reason}" if each.reason.startswith("is ") else f"{each.name}: {each.reason}"
            text += "; cfepy's own would stand in for it" if stands_in else ""
            found.append(MissionProblem(targets, 0, text, is_warning=stands_in))
    for each in model.modules:
        found += [] if each.sources is None else _old_names(each.name, each.sources)
    known = {*module_folders(layout), *(each.name for each in model.modules)}
    startup = find_startup(model)
    if startup is None:
        text = "has no startup script for this processor; cfepy build makes one, or give a file with --startup"
        found.append(MissionProblem(targets, 0, text, is_warning=True))
    for line in () if startup is None else startup.lines:
        name = Path(line.file).name.partition(".")[0]
        if name not in known:
            text = f"the startup script ({startup.origin if startup else ''}) names {name}, which is not in the tree"
            found.append(MissionProblem(targets, 0, text, is_warning=(shipped("apps") / name).is_dir()))
    return [*found, *(MissionProblem(targets, 0, each, is_warning=True) for each in model.notes)]


def _old_names(module: str, sources: Sources) -> Iterator[MissionProblem]:
    """Yield the first name of cFE 6 in a module, and the names that cFE 7 has no counterpart for."""
    files = [*sources.code, *sources.tables, *own_headers(sources)]
    used = used_names(files)
    if used is None:
        return
    name, file, line = used
    yield MissionProblem(file, line, f"{module} uses {name} of cFE 6; build it with {advised_option(files)}", True)
    for each in removed_names(files):
        yield MissionProblem(each.file, each.line, each.text, is_warning=True)
