"""Entry points of ament_python packages: the names of nodes in setup.py or setup.cfg (`console_scripts`).

`ros2 run` starts a node by such a name. The files are read, not executed.
"""

from __future__ import annotations

import ast
import configparser
import os
import re
from collections.abc import Iterator, Mapping
from pathlib import Path
from typing import Any

from cfepy.reading.input_files import text_limited
from cfepy.reading.input_limits import PYTHON_BYTES
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import UsageError

_FILES = ("setup.py", "setup.cfg")
_LINE = re.compile(r"\s*([\w.-]+)\s*=\s*([A-Za-z_][\w.]*)\s*:\s*([A-Za-z_]\w*)\s*")
Target = tuple[str, str]
"""A module and a function in it."""


def entry_points(folder: Path) -> dict[str, Target]:
    """Return the nodes of a package by name.

    Args:
        folder: the folder of its setup.py or setup.cfg.
    """
    found: dict[str, Target] = {}
    for name in _FILES:
        file = folder / name
        if os.path.isfile(file):
            text = text_limited(file, PYTHON_BYTES, "replace")
            for line in _of_python(text) if name == "setup.py" else _of_configuration(text):
                match = _LINE.fullmatch(line)
                if match is not None:
                    found.setdefault(match[1], (match[2], match[3]))
    return found


def entry_of(script: Path, executable: str) -> Target:
    """Return the module and the function of a node.

    Args:
        script: a file in the folder of the package's setup.py.
        executable: name of the node.

    Raises:
        UsageError: the package has no such node.
    """
    found = entry_points(script.parent)
    if executable not in found:
        hint = did_you_mean(executable, found, "give one of console_scripts")
        raise UsageError(f"unknown executable {executable!r} of the package; {hint}", file=str(script))
    return found[executable]


def setup_file(folder: Path) -> Path:
    """Return the file of a package that names its nodes."""
    return next((folder / name for name in _FILES if os.path.isfile(folder / name)), folder / _FILES[0])


def _of_python(text: str) -> Iterator[str]:
    try:
        tree = ast.parse(text)
    except (SyntaxError, ValueError):
        return
    constants = {
        target.id: each.value.value
        for each in tree.body
        if isinstance(each, ast.Assign) and isinstance(each.value, ast.Constant)
        for target in each.targets
        if isinstance(target, ast.Name)
    }
    for node in ast.walk(tree):
        if isinstance(node, ast.Dict):
            for key, value in zip(node.keys, node.values, strict=True):
                if isinstance(key, ast.Constant) and key.value == "console_scripts":
                    yield from _texts(value, constants)


def _texts(node: ast.AST, constants: Mapping[str, Any]) -> Iterator[str]:
    """Yield the lines of a list; names of the file's constants in f-strings and sums are replaced."""
    for each in node.elts if isinstance(node, (ast.List, ast.Tuple)) else [node]:
        text = _text(each, constants)
        yield from text.split("\n") if text is not None else ()


def _text(node: ast.AST, constants: Mapping[str, Any]) -> str | None:
    match node:
        case ast.Constant(value=str(text)):
            return text
        case ast.Name(id=name) if isinstance(constants.get(name), str):
            return str(constants[name])
        case ast.BinOp(left=left, op=ast.Add(), right=right):
            parts = [_text(left, constants), _text(right, constants)]
        case ast.JoinedStr(values=values):
            parts = [_text(each.value if isinstance(each, ast.FormattedValue) else each, constants) for each in values]
        case _:
            return None
    return None if None in parts else "".join(map(str, parts))


def _of_configuration(text: str) -> Iterator[str]:
    parser = configparser.ConfigParser(interpolation=None)
    try:
        parser.read_string(text)
        yield from parser.get("options.entry_points", "console_scripts", fallback="").split("\n")
    except configparser.Error:
        return
