"""Checks of Python sources without running them: whether they are valid, and whether they define a startup script's
names.

A syntax tree cannot answer everything. Names from a star import or a module's `__getattr__` count as defined.
"""

from __future__ import annotations

import ast
import importlib.util
import os
import re
from collections.abc import Iterable, Iterator
from pathlib import Path

from cfepy.interpreter.syntax_trees import parsed_input
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import PYTHON_BYTES
from cfepy.status import UsageError

_MOST_MODULES = 100  # maximum number of modules to follow
_STAR_IMPORT = re.compile(rb"import\s*\\?\s*\*")
PACKAGE_FILE = "__init__.py"


def source_of(code: Path | str) -> Path | None:
    """Return the file behind a result of `find_code`; None if it is not Python source (an extension module)."""
    if isinstance(code, Path):
        return code
    spec = importlib.util.find_spec(code)
    path = Path(spec.origin) if spec is not None and spec.origin is not None else None
    return path if path is not None and path.suffix == ".py" else None


def files_of(source: Path) -> list[Path]:
    """Return the sources that belong to a module: the file itself, or all files of its package."""
    return sorted(source.parent.rglob("*.py")) if source.name == PACKAGE_FILE else [source]


def syntax_error(source: Path) -> tuple[int, str] | None:
    """Return (line, error) of a file that is not valid Python, or None."""
    try:
        parsed_input(read_limited(source, PYTHON_BYTES), str(source))
    except SyntaxError as error:
        return error.lineno or 1, error.msg
    except UsageError as error:
        return 0, error.text
    except (ValueError, OSError) as error:
        return 1, str(error)
    return None


def functions_of(source: Path) -> list[str]:
    """Return the functions defined in a module, for suggestions."""
    return [node.name for node in tree_of(source).body if isinstance(node, ast.FunctionDef)]


def functions_and_classes_of(source: Path) -> list[str]:
    """Return the functions and classes defined in a module, for suggestions."""
    return [node.name for node in tree_of(source).body if isinstance(node, ast.FunctionDef | ast.ClassDef)]


def defines(source: Path, name: str) -> bool:
    """Return whether a module without syntax errors has, or may have, a name at its top level."""
    return _defines(source, name, set())


def _defines(source: Path, name: str, seen: set[Path]) -> bool:
    """Return whether a module defines a name; modules in `seen` were searched before, and may import each other."""
    seen.add(source)
    text = _text_of(source)
    if not _may_define(text, name):
        return False
    return any(_binds(statement, source, name, seen) for statement in _statements(_parsed(text).body))


def _may_define(text: bytes, name: str) -> bool:
    """Return whether a text must be parsed to look for a name; most sources do not contain the name at all.

    Python converts some other letters in names to ASCII, so a text with other characters is always parsed.
    """
    return (
        not text.isascii() or name.encode() in text or b"__getattr__" in text or _STAR_IMPORT.search(text) is not None
    )


def tree_of(source: Path) -> ast.Module:
    """Return the syntax tree of a file; an empty module if it is not valid Python, which `syntax_error` reports."""
    return _parsed(_text_of(source))


def _text_of(source: Path) -> bytes:
    try:
        return read_limited(source, PYTHON_BYTES)
    except (UsageError, OSError):
        return b""


def _parsed(text: bytes) -> ast.Module:
    try:
        return parsed_input(text)
    except (SyntaxError, ValueError):
        return ast.Module(body=[], type_ignores=[])


def _statements(body: Iterable[ast.stmt]) -> Iterator[ast.stmt]:
    """Yield the statements that run when a module is imported, including those within `if`, `try`, `with` and loops."""
    waiting = list(body)[::-1]
    while waiting:
        statement = waiting.pop()
        yield statement
        inner: list[ast.stmt] = []
        for block in ("body", "orelse", "finalbody"):
            if not isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
                inner += getattr(statement, block, ())
        for handler in getattr(statement, "handlers", ()):
            inner += handler.body
        waiting += inner[::-1]


def _binds(statement: ast.stmt, source: Path, name: str, seen: set[Path]) -> bool:
    if isinstance(statement, ast.FunctionDef | ast.AsyncFunctionDef | ast.ClassDef):
        return statement.name in (name, "__getattr__")
    if isinstance(statement, ast.ImportFrom):
        return any(_imports(statement, alias, source, name, seen) for alias in statement.names)
    if isinstance(statement, ast.Import):
        return any((alias.asname or alias.name.partition(".")[0]) == name for alias in statement.names)
    targets = getattr(statement, "targets", [getattr(statement, "target", None)])
    return any(
        isinstance(node, ast.Name) and node.id == name for target in targets if target for node in ast.walk(target)
    )


def _imports(statement: ast.ImportFrom, alias: ast.alias, source: Path, name: str, seen: set[Path]) -> bool:
    """Return whether `from x import alias` defines `name`; modules of the same package are searched."""
    if alias.name != "*" and (alias.asname or alias.name) != name:
        return False
    sibling = source.parent / f"{statement.module}.py" if statement.level == 1 and statement.module else None
    if sibling is None or not os.path.isfile(sibling) or sibling in seen or len(seen) > _MOST_MODULES:
        return True
    return _defines(sibling, name if alias.name == "*" else alias.name, seen)
