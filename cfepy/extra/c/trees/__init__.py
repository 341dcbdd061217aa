"""Whole cFS mission trees: reading targets.cmake and the files of all applications, and building a mission folder.

Code that reads the files of a tree, or that makes a mission folder from one, belongs here. The reader of CMake's
language, the compiler, and the build of one application from known sources are in `cfepy.extra.c.toolchain`. The
central file is `cfepy/extra/c/trees/mission_folder.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.c.trees.build_report import BuildReport
    from cfepy.extra.c.trees.cmake_reader import CMAKE_NOTE, read_with_cmake
    from cfepy.extra.c.trees.mission_folder import TreeOptions, build_tree
    from cfepy.extra.c.trees.tree_layout import find_layout, is_tree, tree_above
    from cfepy.extra.c.trees.tree_model import TreeModel
    from cfepy.extra.c.trees.tree_reader import read_tree

__all__ = [
    "CMAKE_NOTE",
    "BuildReport",
    "TreeModel",
    "TreeOptions",
    "build_tree",
    "find_layout",
    "is_tree",
    "read_tree",
    "read_with_cmake",
    "tree_above",
]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            ".build_report": ("BuildReport",),
            ".cmake_reader": ("CMAKE_NOTE", "read_with_cmake"),
            ".tree_layout": ("find_layout", "is_tree", "tree_above"),
            ".mission_folder": ("TreeOptions", "build_tree"),
            ".tree_model": ("TreeModel",),
            ".tree_reader": ("read_tree",),
        },
    )
