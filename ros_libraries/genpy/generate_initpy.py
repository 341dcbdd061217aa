"""Writes the `__init__.py` of a folder of generated modules."""

from __future__ import annotations

import os
from collections.abc import Iterable

from genmsg import MsgGenerationException


def write_modules(outdir: str) -> int:
    """Write `__init__.py` for the modules in a folder. Does nothing if the folder does not exist."""
    if os.path.isdir(outdir):
        files = sorted(os.listdir(outdir))
        write_module(outdir, [f"_{name[1:-3]}" for name in files if name.endswith(".py") and name != "__init__.py"])
    return 0


def write_module(basedir: str, generated_modules: Iterable[str]) -> None:
    """Write an `__init__.py` that imports all from some modules.

    Raises:
        MsgGenerationException: there is a file in the folder's place.
    """
    if os.path.exists(basedir) and not os.path.isdir(basedir):
        raise MsgGenerationException(f"file preventing the creating of module directory: {basedir}")
    os.makedirs(basedir, exist_ok=True)
    with open(os.path.join(basedir, "__init__.py"), "w", encoding="utf-8") as file:
        file.writelines(f"from .{module} import *\n" for module in generated_modules)
