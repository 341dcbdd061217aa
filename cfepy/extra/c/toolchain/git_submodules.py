"""Git submodules of a source tree, from its .gitmodules: a submodule that was never fetched is an empty folder."""

from __future__ import annotations

import configparser
import os
from pathlib import Path

from cfepy.reading.input_files import text_limited
from cfepy.reading.input_limits import CMAKE_BYTES

FILE = ".gitmodules"
_LEVELS = 6  # of folders above a file


def submodules_of(tree: Path) -> dict[str, str]:
    """Return the submodules of a tree: the path in the tree, and the URL; empty if it has none."""
    file = tree / FILE
    if not file.is_file():
        return {}
    reader = configparser.RawConfigParser(strict=False)
    text = "\n".join(line.strip() for line in text_limited(file, CMAKE_BYTES, "replace").splitlines())
    try:
        reader.read_string(text)
    except configparser.Error:
        return {}
    sections = [dict(reader[each]) for each in reader.sections()]
    return {each["path"]: each.get("url", "") for each in sections if each.get("path")}


def absent_submodule(tree: Path, path: Path) -> str:
    """Return the URL of the submodule that a path is in, if it was not fetched; empty otherwise."""
    inside = os.path.relpath(path, tree)
    for folder, url in submodules_of(tree).items():
        if (inside == folder or inside.startswith(f"{folder}/")) and not has_files(tree / folder):
            return url
    return ""


def absent_submodule_above(path: Path) -> str:
    """Return the URL as `absent_submodule` does, for a tree in one of the folders above."""
    for above in list(path.absolute().parents)[:_LEVELS]:
        if (above / FILE).is_file():
            return absent_submodule(above, path.absolute())
    return ""


def has_files(folder: Path) -> bool:
    """Return True if a folder can be read and is not empty, apart from git's own entry."""
    try:
        return any(each.name != ".git" for each in os.scandir(folder))
    except OSError:
        return False
