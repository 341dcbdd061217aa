"""The first difference of two runs: an observation of a run at a given record, and suspicious lines of source.

The observation has the task that made the record, its line of source, and the records before. The suspicious lines are
guesses from the text of one source file: lines that can make two runs differ, such as iteration over sets, addresses,
and hashes of texts.
"""

from __future__ import annotations

import ast
import linecache
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict, dataclass, replace
from hashlib import blake2b
from pathlib import Path
from types import FrameType
from typing import Any, NamedTuple

from cfepy.interpreter.own_code import is_library, is_shown, is_standard
from cfepy.interpreter.syntax_trees import parsed_input
from cfepy.nodes.node_sources import own_files
from cfepy.reading.input_files import text_limited
from cfepy.reading.input_limits import PYTHON_BYTES
from cfepy.trace import TimedRecords, Trace

_SET_MAKERS = frozenset({"set", "frozenset"})
_SET_METHODS = frozenset({"union", "intersection", "difference", "symmetric_difference"})
_IN_ORDER = frozenset({"list", "tuple", "enumerate", "iter", "map", "filter", "zip", "fromkeys", "join", "next"})
_OF_THE_PROCESS = {"id": "an address", "hash": "the hash of a text, which follows PYTHONHASHSEED"}
_PAST_THE_SIMULATION = {
    "sqlite3.connect": "calls a C library, which uses the clock and random numbers of this computer",
    "sys.getrefcount": "counts objects of the whole process",
    "gc.get_count": "counts objects of the whole process",
    "gc.get_objects": "returns objects of the whole process",
    "gc.get_stats": "counts objects of the whole process",
    "ctypes.addressof": "uses an address",
    "crypt.mksalt": "draws random numbers of this computer",
    "numpy.empty": "returns uninitialized memory",
    "numpy.empty_like": "returns uninitialized memory",
    "weakref.WeakSet": "is a set that is ordered by addresses",
}
"""Functions with a different result in each run, by their full names."""
_CLOCKS = {"numpy.datetime64": ("now", "today")}
_CLOCK = "asks the clock of this computer"
_OUTSIDE = frozenset([_PAST_THE_SIMULATION[name] for name in ("sqlite3.connect", "crypt.mksalt")] + [_CLOCK])
_OPERATORS = (ast.BitOr, ast.BitAnd, ast.Sub, ast.BitXor)


@dataclass(frozen=True, slots=True)
class Line:
    """A line of executed code: file, number, function, and its text."""

    file: str
    number: int
    function: str
    source: str


@dataclass(frozen=True, slots=True)
class Look:
    """The state of a run at a record.

    Attributes:
        record: its bytes; empty if the run ended before.
        before: a digest of all records before it.
        lines: the last records before it and the record itself, as text.
        stack: the executed lines of node, application and libraries, the outermost first.
        files: the nodes' own source files.
        contacts: accesses to the computer outside the simulation before it, as text.
    """

    record: bytes
    before: str
    lines: tuple[str, ...]
    stack: tuple[Line, ...]
    files: tuple[str, ...]
    contacts: tuple[str, ...] = ()

    def to_dict(self) -> dict[str, Any]:
        """Return the observation as plain data."""
        return asdict(self) | {"record": self.record.hex()}

    @classmethod
    def from_dict(cls, plain: dict[str, Any]) -> Look:
        """Return an observation from the data of `to_dict`."""
        stack = tuple(Line(**line) for line in plain["stack"])
        record = bytes.fromhex(plain["record"])
        return cls(
            record, plain["before"], tuple(plain["lines"]), stack, tuple(plain["files"]), tuple(plain["contacts"])
        )

    def without_root(self, root: str) -> Look:
        """Return the same observation with source paths without this root folder."""
        stack = tuple(replace(line, file=line.file.removeprefix(root)) for line in self.stack)
        return replace(self, stack=stack, files=tuple(file.removeprefix(root) for file in self.files))

    @property
    def culprit(self) -> Line | None:
        """The innermost line of the mission's own code, not of a library."""
        own = [line for line in self.stack if not is_library(line.file)]
        return own[-1] if own else None


class _Counted(TimedRecords):
    """A list of trace records that calls `reached` at the record with a given number."""

    def __init__(self, index: int, reached: Callable[[bytes], object]) -> None:
        super().__init__()
        self._left = index
        self._reached = reached

    def append(self, record: bytes) -> None:
        """Append a record; the host's empty marks are not counted."""
        if record:
            if self._left == 0:
                self._reached(record)
            self._left -= 1
        super().append(record)


class LookingTrace(Trace):
    """A trace that makes an observation at a given record.

    Args:
        index: number of the record, from 0.
        describe: returns text lines for records; it gets up to two batches that end with the record.
        seen: called with the observation, inside the simulation.
    """

    __slots__ = ("_before", "_counted", "_describe", "_latest", "_seen")

    def __init__(
        self, index: int, describe: Callable[[list[bytes]], list[str]], seen: Callable[[Look], object]
    ) -> None:
        counted = _Counted(index, self._look)
        super().__init__(self._keep, counted)
        self._before = blake2b(digest_size=16)
        self._latest = TimedRecords()
        self._describe = describe
        self._seen = seen
        self._counted = counted

    def _keep(self, records: list[bytes]) -> None:
        self._latest = TimedRecords()
        self._add_to(self._latest)
        self._before.update(b"".join(self._latest))

    def _add_to(self, shown: TimedRecords) -> None:
        """Add the collected records, except the host's empty marks."""
        for record, time_ns in zip(self._counted, self._counted.times, strict=True):
            if record:
                shown.add(record, time_ns)

    def _look(self, record: bytes) -> None:
        self._seen(self.look(record, sys._getframe(2)))

    def look(self, record: bytes, frame: FrameType | None = None) -> Look:
        """Return an observation of the present state.

        Args:
            record: the record about to be made; empty at the end of the run.
            frame: frame of the code that makes it.
        """
        shown = self._latest
        known = len(shown)
        self._add_to(shown)
        self._before.update(b"".join(shown[known:]))
        shown.add(record, self._counted.now())
        lines = self._describe(shown)
        return Look(record, self._before.hexdigest(), tuple(lines), stack_of(frame), tuple(own_files()))


def stack_of(frame: FrameType | None) -> tuple[Line, ...]:
    """Return the lines of node, application and libraries that a frame and its callers execute, outermost first."""
    found: list[Line] = []
    while frame is not None:
        code = frame.f_code
        if is_shown(code.co_filename):
            text = linecache.getline(code.co_filename, frame.f_lineno).strip()
            found.append(Line(code.co_filename, frame.f_lineno, code.co_qualname, text))
        frame = frame.f_back
    return tuple(reversed(found))


def place_text(frame: FrameType | None) -> str:
    """Return the innermost line of the mission's own code in a stack: `arm.py:12: self.count += 1`.

    In a thread of a library it is a line of the library. It is empty if only Python's own code runs.
    """
    shown: list[Line] = [line for line in stack_of(frame) if not is_standard(line.file)]
    lines = [line for line in shown if not is_library(line.file)] or shown
    if not lines:
        return ""
    source = " ".join(lines[-1].source.partition("  #")[0].split())
    return f"{Path(lines[-1].file).name}:{lines[-1].number}: {source}"


class Suspect(NamedTuple):
    """A suspicious line, with the reason."""

    file: str
    line: int
    why: str
    source: str


_DEPTH = 300  # deeper nesting is not examined


def suspects(file: str) -> list[Suspect]:
    """Return the suspicious lines of a Python file, in order; empty if it cannot be read."""
    try:
        text = text_limited(file, PYTHON_BYTES)
        tree = parsed_input(text, depth=_DEPTH)
    except (OSError, SyntaxError, ValueError):
        return []
    lines = text.splitlines()
    found = sorted(set(_Reader(tree).found()))
    return [Suspect(file, number, why, lines[number - 1].strip()) for number, why in found]


def outside_lines() -> list[str]:
    """Return the lines of the nodes' own files that query this computer, executed or not, as text."""
    found = [each for file in own_files() for each in suspects(file) if each.why in _OUTSIDE]
    return [f"{Path(each.file).name}:{each.line}: {each.source}: {each.why}" for each in found]


class _Reader:
    """Examines a module; a name counts as a set if one is assigned to it anywhere.

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
        self._imported = dict(_imports(tree))

    def found(self) -> Iterator[tuple[int, str]]:
        """Yield the number of each suspicious line, with the reason."""
        for node in ast.walk(self._tree):
            if isinstance(node, (ast.For, ast.comprehension)) and self._is_set(node.iter):
                yield node.iter.lineno, "goes through a set"
            elif isinstance(node, ast.Call):
                yield from self._call(node)

    def _call(self, node: ast.Call) -> Iterator[tuple[int, str]]:
        name = _name(node.func).rpartition(".")[2]
        if isinstance(node.func, ast.Name) and name in _OF_THE_PROCESS:
            yield node.lineno, f"uses {_OF_THE_PROCESS[name]}"
        key = next((_name(each.value) for each in node.keywords if each.arg == "key"), "")
        if key in _OF_THE_PROCESS:
            yield node.lineno, f"sorts by {_OF_THE_PROCESS[key]}"
        if name in _IN_ORDER and any(map(self._is_set, node.args)):
            yield node.lineno, "goes through a set"
        if name == "pop" and isinstance(node.func, ast.Attribute) and self._is_set(node.func.value):
            yield node.lineno, "takes any element of a set"
        first, dot, rest = _name(node.func).partition(".")
        whole = self._imported.get(first, "") + dot + rest
        if whole in _PAST_THE_SIMULATION:
            yield node.lineno, _PAST_THE_SIMULATION[whole]
        words = [each.value for each in node.args if isinstance(each, ast.Constant)]
        if words[:1] and words[0] in _CLOCKS.get(whole, ()):
            yield node.lineno, _CLOCK

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


def _imports(tree: ast.Module) -> Iterator[tuple[str, str]]:
    """Yield the names from imports with their full names: `np` and `numpy`, `connect` and `sqlite3.connect`."""
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for each in node.names:
                first = each.name.partition(".")[0]
                yield (each.asname, each.name) if each.asname else (first, first)
        elif isinstance(node, ast.ImportFrom):
            yield from ((each.asname or each.name, f"{node.module}.{each.name}") for each in node.names)


def _name(node: ast.AST) -> str:
    """Return `name` or `self.name` as text; empty for any other expression."""
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        return f"{_name(node.value)}.{node.attr}"
    return ""
