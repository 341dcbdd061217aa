"""A predicate over messages in a mission file: one Python expression, checked when it is read.

Its allowed names are known, so a misspelt one is found before the mission boots. If a predicate does not hold, the
values that it used can be shown.
"""

from __future__ import annotations

import ast
import builtins
import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from types import CodeType
from typing import Any

from cfepy.interpreter.syntax_trees import parsed_input
from cfepy.reading.input_limits import EXPRESSION_CHARACTERS, EXPRESSION_DEPTH
from cfepy.reading.marked_yaml import Marked
from cfepy.reading.suggestions import did_you_mean
from cfepy.status import together

LATEST = "latest"
MOST_SHOWN = 120  # maximum number of characters of a value in a text
_LIBRARY: dict[str, Any] = {"math": math}


@dataclass(frozen=True, slots=True)
class Predicate:
    """An expression.

    Attributes:
        source: its text, on one line.
        place: its place: `file:line: field`.
        topics: topics that it reads from `latest`.
    """

    source: str
    place: str
    topics: tuple[str, ...] = ()
    _code: CodeType | None = field(default=None, repr=False, compare=False)
    _shown: tuple[str, ...] = ()

    @classmethod
    def read(cls, entry: Marked, names: Iterable[str]) -> Predicate:
        """Return the predicate in a mission file.

        Args:
            entry: its text.
            names: names that it may use in addition to Python's built-in functions and `math`.

        Raises:
            UsageError: if it is not an expression, or uses another name.
        """
        source = _one_line(entry)
        if len(source) > EXPRESSION_CHARACTERS:
            raise entry.fail(f"must have at most {EXPRESSION_CHARACTERS:,} characters, not {len(source):,}; split it")
        try:
            tree = parsed_input(source, mode="eval", depth=EXPRESSION_DEPTH)
        except (SyntaxError, ValueError) as error:
            what = error.msg if isinstance(error, SyntaxError) else str(error)
            raise entry.fail(f"invalid Python expression {source!r}: {what}") from None
        _check_names(entry, tree, tuple(names))
        place = f"{entry.file.name}:{entry.line}: {entry.field}"
        code = compile(tree, place, "eval")
        return cls(source, place, tuple(dict.fromkeys(_asked(tree))), code, tuple(dict.fromkeys(_looked_at(tree))))

    def holds(self, names: Mapping[str, Any]) -> bool:
        """Return whether it holds.

        Args:
            names: values of the names that it may use.

        Raises:
            Exception: raised by its evaluation.
        """
        assert self._code is not None
        return bool(eval(self._code, {"__builtins__": builtins, **_LIBRARY, **names}))

    def values(self, names: Mapping[str, Any]) -> str:
        """Return the values that it used, for the text about a violation: "msg.data is 5, last.data is 3"."""
        found = []
        for source in self._shown:
            try:
                value = eval(source, {"__builtins__": builtins, **_LIBRARY, **names})
            except Exception:
                continue  # not evaluated, such as last.data if last is None
            found.append(f"{source} is {short(value)}")
        return ", ".join(found)


def short(value: Any) -> str:
    """Return a value on one line, truncated if it is long."""
    return shortened(" ".join(repr(value).split()))


def shortened(text: str) -> str:
    """Return a text, truncated if it is long."""
    return text if len(text) <= MOST_SHOWN else f"{text[:MOST_SHOWN]}..."


def _one_line(entry: Marked) -> str:
    if isinstance(entry.value, bool | int | float):
        return repr(entry.value)
    return " ".join(entry.text().split("\n")).strip()


def _check_names(entry: Marked, tree: ast.AST, names: tuple[str, ...]) -> None:
    bound = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    bound |= {node.arg for node in ast.walk(tree) if isinstance(node, ast.arg)}
    known = {*names, *_LIBRARY, *bound, *dir(builtins)}
    used = dict.fromkeys(node.id for node in ast.walk(tree) if isinstance(node, ast.Name))
    unknown = [name for name in used if name not in known]
    if not unknown:
        return
    known_here = f"known names are {', '.join(names)} and Python's built-in names"
    plain = [name for name in dir(builtins) if name.islower() and not name.startswith("_")]
    similar = [*names, *_LIBRARY, *sorted(bound), *plain]
    hints = [(name, did_you_mean(name, similar, known_here)) for name in unknown]
    raise together([entry.fail(f"unknown name {name!r}; {hint}") for name, hint in hints])


def _asked(tree: ast.AST) -> Iterator[str]:
    """Return the topics in `latest["/name"]` and `latest.get("/name")`."""
    for node in ast.walk(tree):
        key: ast.expr | None = None
        if isinstance(node, ast.Subscript) and _is_latest(node.value):
            key = node.slice
        elif isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and _is_latest(node.func.value):
            key = node.args[0] if node.args else None
        if isinstance(key, ast.Constant) and isinstance(key.value, str):
            yield key.value


def _is_latest(node: ast.AST) -> bool:
    return isinstance(node, ast.Name) and node.id == LATEST


def _looked_at(tree: ast.Expression) -> Iterator[str]:
    """Return the names, fields and items that an expression reads, outermost ones only, without loop variables."""
    loops = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Store)}
    waiting: list[ast.AST] = [tree.body]
    while waiting:
        node = waiting.pop(0)
        inner = [each.id for each in ast.walk(node) if isinstance(each, ast.Name)]
        if isinstance(node, ast.Attribute | ast.Subscript | ast.Name):
            is_value = bool(inner) and not loops & set(inner) and not set(inner) <= {*dir(builtins), *_LIBRARY}
            if is_value and not any(isinstance(each, ast.Call) for each in ast.walk(node)):
                yield ast.unparse(node)
                continue
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Attribute) and not _is_latest(node.func.value):
            waiting = [node.func.value, *node.args, *waiting]
            continue
        waiting = [*ast.iter_child_nodes(node), *waiting]
