"""What in a source file may make two runs of a program differ: iterated sets, addresses, hashes of texts.

It is a guess from the text of one file, to point somebody who looks for a cause to the lines worth reading.
"""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path
from typing import NamedTuple

_SET_MAKERS = frozenset({"set", "frozenset"})
_SET_METHODS = frozenset({"union", "intersection", "difference", "symmetric_difference"})
_IN_ORDER = frozenset({"list", "tuple", "enumerate", "iter", "map", "filter", "zip", "fromkeys", "join", "next"})
_OF_THE_PROCESS = {"id": "an address", "hash": "the hash of a text, which follows PYTHONHASHSEED"}
_OPERATORS = (ast.BitOr, ast.BitAnd, ast.Sub, ast.BitXor)


class Suspect(NamedTuple):
    """A line that may be the cause, and why."""

    file: str
    line: int
    why: str
    source: str


def suspects(file: str) -> list[Suspect]:
    """The suspicious lines of a Python file, in order; none when it cannot be read."""
    try:
        text = Path(file).read_text(encoding="utf-8")
        tree = ast.parse(text)
    except (OSError, SyntaxError, ValueError):
        return []
    lines = text.splitlines()
    found = sorted(set(_Reader(tree).found()))
    return [Suspect(file, number, why, lines[number - 1].strip()) for number, why in found]


class _Reader:
    """Looks through a module; a name counts as a set when one is assigned to it anywhere.

    Args:
        tree: the module.
    """

    def __init__(self, tree: ast.Module) -> None:
        self._tree = tree
        self._sets: set[str] = set()
        for node in ast.walk(tree):
            if isinstance(node, ast.Assign) and self._is_set(node.value):
                self._sets.update(map(_name, node.targets))
            elif isinstance(node, ast.AnnAssign) and self._is_set(node.value):
                self._sets.add(_name(node.target))
        self._sets.discard("")

    def found(self) -> Iterator[tuple[int, str]]:
        """Number of each suspicious line, and why it is one."""
        for node in ast.walk(self._tree):
            if isinstance(node, (ast.For, ast.comprehension)) and self._is_set(node.iter):
                yield node.iter.lineno, "goes through a set"
            elif isinstance(node, ast.Call):
                yield from self._call(node)

    def _call(self, node: ast.Call) -> Iterator[tuple[int, str]]:
        name = _name(node.func).rpartition(".")[2]
        if isinstance(node.func, ast.Name) and name in _OF_THE_PROCESS:
            yield node.lineno, f"uses {_OF_THE_PROCESS[name]}"
        if name in _IN_ORDER and any(map(self._is_set, node.args)):
            yield node.lineno, "goes through a set"
        if name == "pop" and isinstance(node.func, ast.Attribute) and self._is_set(node.func.value):
            yield node.lineno, "takes any element of a set"

    def _is_set(self, node: ast.expr | None) -> bool:
        if isinstance(node, (ast.Set, ast.SetComp)):
            return True
        if isinstance(node, ast.Call):
            if isinstance(node.func, ast.Attribute):
                return node.func.attr in _SET_METHODS and self._is_set(node.func.value)
            return _name(node.func) in _SET_MAKERS
        if isinstance(node, ast.BinOp):
            return isinstance(node.op, _OPERATORS) and (self._is_set(node.left) or self._is_set(node.right))
        return node is not None and _name(node) in self._sets


def _name(node: ast.AST) -> str:
    """`name` or `self.name` as text; empty for anything else."""
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        return f"{_name(node.value)}.{node.attr}"
    return ""
