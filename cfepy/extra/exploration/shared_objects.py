"""The names of a node's locks, events, queues and similar objects: the variable and the line at which they were made.

An object is known from its creation: the line of the mission's own code that called `threading.Lock()` shows its
variable. If the creation was not seen, the name is looked up among the variables of the code that uses it.
"""

from __future__ import annotations

import ast
import linecache
from collections import Counter
from collections.abc import Iterator
from pathlib import PurePath
from types import CodeType, FrameType
from typing import Any, NamedTuple

from cfepy.interpreter.own_code import is_own_code, is_shown, is_standard
from cfepy.interpreter.syntax_trees import parsed_input
from cfepy.reading.input_files import read_limited
from cfepy.reading.input_limits import PYTHON_BYTES

_MAKING = "__init__"
_SELF = "self"
ITEM = "[]"  # after the name of a list that a comprehension makes


class Use(NamedTuple):
    """A call of the mission's code or of a ROS library that reaches a lock, directly or through Python's library.

    Attributes:
        subject: the object whose method is called: a lock, or an Event, Condition, Queue, Thread around it.
        call: the method's name.
        inner: the frame of the method of Python's library; None for a direct call of the lock.
        frame: of the code that calls it.
    """

    subject: Any
    call: str
    inner: FrameType | None
    frame: FrameType


def use_of(subject: Any, call: str, frame: FrameType | None) -> Use | None:
    """Return the call that uses a lock; None for a use inside Python's library.

    Args:
        subject: the lock.
        call: its method.
        frame: of the code that calls it.
    """
    inner = None
    while frame is not None and is_standard(frame.f_code.co_filename):
        inner, frame = frame, frame.f_back
    if frame is None or not is_shown(frame.f_code.co_filename):
        return None
    if inner is None:
        return Use(subject, call, None, frame)
    return Use(inner.f_locals.get(_SELF), inner.f_code.co_name, inner, frame)


class Things:
    """The names of objects. Each object is kept alive, so that its address identifies it."""

    def __init__(self) -> None:
        self._names: dict[int, tuple[Any, str]] = {}
        self._made: Counter[str] = Counter()

    def made(self, lock: Any, frame: FrameType | None) -> None:
        """Record the creation of a lock.

        Args:
            lock: the lock.
            frame: of the code that called its class.
        """
        makers = [lock]
        while frame is not None and is_standard(frame.f_code.co_filename):
            maker = frame.f_locals.get(_SELF)
            if maker is not None and frame.f_code.co_name != _MAKING:
                return  # a lock of a wait or similar, which no other code sees
            makers += [] if maker is None else [maker]
            frame = frame.f_back
        if frame is None or not is_own_code(frame.f_code.co_filename):
            return
        known = self._names.get(id(makers[-1]))  # from another lock of the same object
        name = self._new_name(frame) if known is None else known[1]
        for each in makers:
            self._names.setdefault(id(each), (each, name))

    def name(self, subject: Any, frame: FrameType | None = None) -> str:
        """Return the name of an object, `self.lock (bank.py:12)`; empty if it is not known.

        Args:
            subject: the object.
            frame: of code that uses it.
        """
        known = self._names.get(id(subject))
        if known is not None:
            return known[1]
        found = next((name for name, value in _variables(frame) if value is subject), "")
        if found and frame is not None:
            self._names[id(subject)] = subject, found
        return found

    def _new_name(self, frame: FrameType) -> str:
        variable = _variable_of(frame)
        place = f"({PurePath(frame.f_code.co_filename).name}:{frame.f_lineno})"
        number = self._made[variable + place]
        self._made[variable + place] += 1
        if variable.endswith(ITEM):
            return f"{variable.removesuffix(ITEM)}[{number}] {place}"
        return f"{variable}#{number + 1} {place}" if number else f"{variable} {place}"


_DEPTH = 100  # more deeply nested source is not examined


def is_made_of(file: str, read: str, written: str, variable: str) -> bool:
    """Return True if the value that a statement writes into a variable comes from an earlier read of it.

    Args:
        file: the source of both.
        read: place of the read, `bank.py:12`.
        written: place of the write.
        variable: name of an attribute or of a variable that several functions share.
    """
    read_at, written_at = (int(place.rpartition(":")[2]) for place in (read, written))
    try:
        tree = parsed_input(_source(file), depth=_DEPTH)
    except (OSError, SyntaxError, ValueError):
        return False
    sources: dict[str, list[ast.AST]] = {}
    values: list[ast.AST] = []
    for node in ast.walk(tree):
        if isinstance(node, ast.AugAssign) and node.lineno == written_at == read_at:
            return True
        if isinstance(node, ast.Assign) and read_at <= node.lineno <= written_at:
            for target in node.targets:
                sources.setdefault(ast.unparse(target), []).append(node.value)
            values += [node.value] if node.lineno == written_at else []
    return _comes_from(values, sources, variable)


def _source(file: str) -> bytes:
    """Return a source file; in a replay, the one of the journal, which `linecache` has without a time."""
    entry = linecache.cache.get(file)
    if entry is not None and len(entry) == 4 and entry[1] is None:
        return "".join(entry[2]).encode()
    return read_limited(file, PYTHON_BYTES)


def _comes_from(values: list[ast.AST], sources: dict[str, list[ast.AST]], variable: str) -> bool:
    """Return True if values, or the sources of the local variables in them, contain a variable."""
    known: set[str] = set()
    while values:
        for node in ast.walk(values.pop()):
            name = node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""
            if name == variable:
                return True
            if isinstance(node, ast.Name) and name not in known:
                known.add(name)
                values += sources.get(name, [])
    return False


def _variables(frame: FrameType | None) -> Iterator[tuple[str, Any]]:
    if frame is None or not is_own_code(frame.f_code.co_filename):
        return
    yield from list(frame.f_locals.items())
    for name, value in list(frame.f_locals.items()):
        for attribute, held in list(getattr(value, "__dict__", {}).items()) if name == _SELF else ():
            yield f"{name}.{attribute}", held
    yield from list(frame.f_globals.items())


def _variable_of(frame: FrameType) -> str:
    """Return the variable to which the current call of a frame is assigned; `lock` if there is none."""
    try:
        tree = parsed_input(read_limited(frame.f_code.co_filename, PYTHON_BYTES), depth=_DEPTH)
    except (OSError, SyntaxError, ValueError):
        return "lock"
    place = _position(frame.f_code, frame.f_lasti)
    return next((name for name, call in _assigned(tree) if _place(call) == place), "lock")


def _position(code: CodeType, instruction: int) -> tuple[int | None, ...]:
    return list(code.co_positions())[instruction // 2]


def _place(node: ast.AST) -> tuple[int | None, ...]:
    return tuple(getattr(node, name) for name in ("lineno", "end_lineno", "col_offset", "end_col_offset"))


def _assigned(tree: ast.AST) -> Iterator[tuple[str, ast.Call]]:
    """Yield the calls of a module whose results are assigned to variables, with the variables' names."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Assign):
            yield from _pairs(node.targets[0], node.value)
        elif isinstance(node, ast.AnnAssign | ast.NamedExpr) and node.value is not None:
            yield from _pairs(node.target, node.value)


def _pairs(target: ast.expr, value: ast.expr) -> Iterator[tuple[str, ast.Call]]:
    if isinstance(target, ast.Tuple | ast.List):
        if isinstance(value, ast.Tuple | ast.List) and len(value.elts) == len(target.elts):
            for each, its_value in zip(target.elts, value.elts, strict=True):
                yield from _pairs(each, its_value)
        return
    name = ast.unparse(target)
    if isinstance(value, ast.Call):
        yield name, value
    elif isinstance(value, ast.List | ast.Tuple | ast.Set):
        yield from ((f"{name}[{number}]", each) for number, each in enumerate(value.elts) if isinstance(each, ast.Call))
    elif isinstance(value, ast.Dict):
        for key, each in zip(value.keys, value.values, strict=True):
            if isinstance(each, ast.Call) and key is not None:
                yield f"{name}[{ast.unparse(key)}]", each
    elif isinstance(value, ast.ListComp | ast.GeneratorExp | ast.SetComp) and isinstance(value.elt, ast.Call):
        yield f"{name}{ITEM}", value.elt
