"""<param command="...">: the output of a program as a parameter. Two programs are stood in for: `cat` and `xacro`.

No process is started: what a program prints could be anything each time. May import nothing of cfepy.
"""

from __future__ import annotations

import importlib
import shlex
from pathlib import Path
from typing import Any

STOOD_IN = {"xacro": Path("xacro")}
"""What $(find) gives for packages whose programs are stood in for, when they are not there."""


def output_of(command: str) -> str:
    """What a command prints.

    Args:
        command: the command line; relative paths in it start at the current folder.

    Raises:
        ValueError: it is neither cat nor xacro, or it fails.
    """
    program, *arguments = shlex.split(command) or [""]
    name = Path(program).name.removesuffix(".py")
    if name not in _PROGRAMS:
        raise ValueError(
            f"would start the program {program!r}, which cfepy does not do; run it yourself, and name its output with"
            " textfile= instead"
        )
    try:
        return _PROGRAMS[name](arguments)
    except OSError as error:
        raise ValueError(f"{command}: {error.strerror}: {error.filename}") from None


def _cat(arguments: list[str]) -> str:
    return "".join(Path(file).read_text(encoding="utf-8") for file in arguments)


def _xacro(arguments: list[str]) -> str:
    """The library xacro, when it is installed where cfepy runs."""
    try:
        xacro: Any = importlib.import_module("xacro")
    except ImportError:
        raise ValueError(
            "needs the Python package xacro, which is not installed here; run `pip install xacro`, or run xacro"
            " yourself and name its output with textfile="
        ) from None
    words = [word for word in arguments if not word.startswith("-")]
    mappings = dict(word.split(":=", 1) for word in words if ":=" in word)
    files = [word for word in words if ":=" not in word]
    if len(files) != 1:
        raise ValueError(f"names {len(files)} files; xacro reads one")
    try:
        return str(xacro.process_file(files[0], mappings=mappings).toprettyxml(indent="  "))
    except OSError:
        raise
    except Exception as error:  # whatever the macros of the file do wrong
        raise ValueError(f"xacro {files[0]}: {error}") from None


_PROGRAMS = {"cat": _cat, "xacro": _xacro}
