"""The layouts that the ground names of a compiled application declare, read from the source without executing it.

`Layout("HEATER_HkTlm_t", [("Value", "u16")])` is evaluated with the constants, layouts and other declarations above
it. A layout made in another way, such as in a loop, is unknown; its line is remembered.
"""

from __future__ import annotations

import ast
import operator
import re
from collections.abc import Callable
from pathlib import Path
from typing import Any, NamedTuple

from cfepy.mission import app_sources as sources
from cfepy.msg import Layout, Measurement, ValueNames
from cfepy.status import UsageError

_TYPE = re.compile(r"(\w+)((?:\[\d+\])*)")
_LAYOUT = "Layout"
_KINDS: dict[str, Callable[..., Any]] = {"ValueNames": ValueNames, "Measurement": Measurement}
"""The kinds of fields that have more than a type."""
_SUMS: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.FloorDiv: operator.floordiv,
}


class DeclaredField(NamedTuple):
    """A field: its line, the type as it is written, and its base with the lengths of an array."""

    line: int
    written: str
    base: str | DeclaredLayout
    counts: tuple[int, ...]


class DeclaredLayout(NamedTuple):
    """A layout in a source file, with its fields by name. `hand_packed` has the wire's byte order, unlike a struct."""

    file: Path
    line: int
    layout: Layout
    fields: dict[str, DeclaredField]
    hand_packed: bool

    @property
    def name(self) -> str:
        """The name of the struct."""
        return self.layout.name


class LayoutsOfSource(NamedTuple):
    """The layouts of some files, and the lines (file, line) of those that could not be read."""

    layouts: list[DeclaredLayout]
    unread: list[tuple[Path, int]]


class _UnknownValueError(Exception):
    """The value of an expression is not certain without executing the file."""


def declared_layouts(source: Path) -> LayoutsOfSource:
    """Return the layouts that a module or a package declares at top level.

    Args:
        source: the module, or the `__init__.py` of the package.
    """
    reader = _Reader()
    for file in sources.files_of(source):
        reader.read(file)
    return LayoutsOfSource(list(reader.layouts.values()), reader.unread)


class _Reader:
    def __init__(self) -> None:
        self.layouts: dict[int, DeclaredLayout] = {}
        """By the id of their `Layout`, which they keep alive."""
        self.unread: list[tuple[Path, int]] = []
        self._values: dict[str, Any] = {}
        self._file = Path()

    def read(self, file: Path) -> None:
        """Evaluate the assignments of a file."""
        self._file = file
        for statement in sources.tree_of(file).body:
            if isinstance(statement, ast.Assign | ast.AnnAssign) and statement.value is not None:
                targets = statement.targets if isinstance(statement, ast.Assign) else [statement.target]
                self._assign([each.id for each in targets if isinstance(each, ast.Name)], statement.value)

    def _assign(self, names: list[str], expression: ast.expr) -> None:
        try:
            value = self._value(expression)
        except (_UnknownValueError, UsageError, TypeError, ValueError, ArithmeticError):
            calls = [each for each in ast.walk(expression) if isinstance(each, ast.Call) and _called(each) == _LAYOUT]
            self.unread += [(self._file, each.lineno) for each in calls]
            for name in names:
                self._values.pop(name, None)
            return
        self._values.update(dict.fromkeys(names, value))

    def _value(self, node: ast.expr) -> Any:
        if isinstance(node, ast.Constant):
            return node.value
        if isinstance(node, ast.Name) and node.id in self._values:
            return self._values[node.id]
        if isinstance(node, ast.List | ast.Tuple):
            return [self._value(each) for each in node.elts]
        if isinstance(node, ast.BinOp):
            return self._sum(node)
        if isinstance(node, ast.JoinedStr):
            return "".join(str(self._value(each)) for each in node.values)
        if isinstance(node, ast.FormattedValue) and node.format_spec is None:
            return self._value(node.value)
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            return -self._value(node.operand)
        if isinstance(node, ast.Call) and _called(node) == _LAYOUT:
            return self._layout(node)
        if isinstance(node, ast.Call) and _called(node) in _KINDS:
            return _KINDS[_called(node)](*map(self._value, node.args), **self._options(node))
        raise _UnknownValueError

    def _sum(self, node: ast.BinOp) -> Any:
        left, right = self._value(node.left), self._value(node.right)
        if type(node.op) is ast.Mult and isinstance(left, int) and isinstance(right, int):
            return left * right
        if type(node.op) not in _SUMS or type(left) is not type(right):
            raise _UnknownValueError
        return _SUMS[type(node.op)](left, right)

    def _options(self, node: ast.Call) -> dict[str, Any]:
        if any(each.arg is None for each in node.keywords):
            raise _UnknownValueError
        return {str(each.arg): self._value(each.value) for each in node.keywords}

    def _layout(self, node: ast.Call) -> Layout:
        given = dict(zip(("name", "fields"), map(self._value, node.args), strict=False)) | self._options(node)
        pairs = [(name, tuple(kind) if isinstance(kind, list) else kind) for name, kind in given.pop("fields")]
        layout = Layout(given.pop("name"), pairs, **given)
        lines = _lines_of(node)
        fields = {
            name: self._field(lines[number] if len(lines) == len(pairs) else node.lineno, kind)
            for number, (name, kind) in enumerate(pairs)
        }
        hand_packed = layout.on_the_wire
        self.layouts[id(layout)] = DeclaredLayout(self._file, node.lineno, layout, fields, hand_packed)
        return layout

    def _field(self, line: int, kind: Any) -> DeclaredField:
        counts: tuple[int, ...] = ()
        if isinstance(kind, tuple):
            kind, counts = kind[0], (kind[1],)
        if isinstance(kind, ValueNames | Measurement):
            kind = kind.type
        if isinstance(kind, Layout):
            written = kind.name + "".join(f"[{count}]" for count in counts)
            return DeclaredField(line, written, self.layouts[id(kind)], counts)
        match = _TYPE.fullmatch(kind)
        if match is None:
            raise _UnknownValueError
        return DeclaredField(line, kind, match[1], counts + tuple(map(int, re.findall(r"\d+", match[2]))))


def _called(node: ast.Call) -> str:
    function = node.func
    return function.id if isinstance(function, ast.Name) else getattr(function, "attr", "")


def _lines_of(node: ast.Call) -> list[int]:
    """Return the lines of the fields, as far as they stand in a list."""
    given = [*node.args[1:2], *(each.value for each in node.keywords if each.arg == "fields")]
    return [each.lineno for each in given[0].elts] if given and isinstance(given[0], ast.List | ast.Tuple) else []
