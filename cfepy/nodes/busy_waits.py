"""Loops that wait for another task without a sleep or a call: `while not self.image: pass`.

On a real computer such a loop uses its processor while other threads run. Here computing takes no virtual time, so no
other task would ever run. Therefore the code of nodes and applications gets a hook in each loop that can turn without
doing anything. From the 1001st such turn in a row the hook uses virtual time, so other tasks run. A turn counts if the
task used no virtual time since the turn before. Only turns count, not wall time, so every run is the same.

A loop gets the hook if one of its turns can pass without a call, and if that turn changes nothing in at least one of
the conditions that it checks. A loop that computes changes its own conditions; `while True: pass` has none, and the
stall watch ends it.
"""

from __future__ import annotations

import ast
import os
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import TYPE_CHECKING

from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from cfepy.rtos import Kernel

HOOK = "__turns__"
FREE_TURNS = 1000  # that take no virtual time, so that a short loop changes nothing
FINE_TURNS = 1000  # that take as long as a call
COARSE_NS = 100_000  # time of each later turn: CPython switches between threads every 5 ms
MOST_TASKS = 64  # whose turns are counted at a time
_GIVES_WAY = ast.Await | ast.Yield | ast.YieldFrom
# fmt: off
_PURE = frozenset({
    "abs", "all", "any", "bool", "float", "int", "isinstance", "len", "max", "min", "print", "round", "str", "sum",
    "tuple",
})
# fmt: on


# -- finding -----------------------------------------------------------------------------------------------------------


def busy_loops(tree: ast.Module) -> list[ast.While]:
    """Return the loops of a module that can wait without a call."""
    return [node for node in ast.walk(tree) if isinstance(node, ast.While) and _may_wait(node)]


def add_hooks(loops: Iterable[ast.While], file: str) -> None:
    """Let each turn of some loops call the hook with the file and the line of the loop."""
    for loop in loops:
        place = ast.Tuple([ast.Constant(file), ast.Constant(loop.lineno)], ast.Load())
        call = ast.Expr(ast.Call(ast.Name(HOOK, ast.Load()), [place], []))
        for node in ast.walk(call):
            if isinstance(node, ast.expr | ast.stmt):
                ast.copy_location(node, loop)
                node.end_lineno, node.end_col_offset = loop.lineno, loop.col_offset
        loop.body.insert(0, call)


def _may_wait(loop: ast.While) -> bool:
    turn = _Turn()
    turn.check(loop.test)
    if any(isinstance(each, _GIVES_WAY) for each in ast.walk(loop.test)):
        return False
    return turn.passes(loop.body) and any(not turn.changes(each) for each in turn.conditions)


class _Turn:
    """One turn of a loop that makes no call except in conditions.

    Attributes:
        conditions: the parts of the conditions that it checks, without constants.
        stored: the variables, as dotted names, that it changes.
    """

    def __init__(self) -> None:
        self.conditions: list[ast.expr] = []
        self.stored: set[str] = set()

    def check(self, test: ast.expr) -> None:
        """Add a condition."""
        if isinstance(test, ast.BoolOp):
            for each in test.values:
                self.check(each)
        elif isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
            self.check(test.operand)
        elif not isinstance(test, ast.Constant):
            self.conditions.append(test)
            self.stored.update(each.target.id for each in ast.walk(test) if isinstance(each, ast.NamedExpr))

    def passes(self, block: list[ast.stmt]) -> bool:
        """Return whether a turn can pass through a block without a call; adds its conditions and its changes."""
        for node in block:
            if isinstance(node, ast.Continue):
                return True
            if isinstance(node, ast.If):
                self.check(node.test)
                if not self._passes_one_of(node.body, node.orelse):
                    return False
            elif isinstance(node, ast.Try):
                if not self.passes([*node.body, *node.orelse, *node.finalbody]):
                    return False
            elif not self._is_quiet(node):
                return False
        return True

    def _passes_one_of(self, *branches: list[ast.stmt]) -> bool:
        """Return whether a turn can pass through one of two branches; adds those that it can pass through."""
        passed = False
        for branch in branches:
            inside = _Turn()
            if inside.passes(branch):
                passed = True
                self.conditions += inside.conditions
                self.stored |= inside.stored
        return passed

    def _is_quiet(self, node: ast.stmt) -> bool:
        """Return whether a statement makes no call; adds the variables that it changes."""
        if not isinstance(node, ast.Pass | ast.Expr | ast.Assign | ast.AnnAssign | ast.AugAssign | ast.For | ast.While):
            return False
        for each in ast.walk(node):
            if isinstance(each, ast.Call) and not (isinstance(each.func, ast.Name) and each.func.id in _PURE):
                return False
            if isinstance(each, _GIVES_WAY | ast.Return | ast.Raise):
                return False
            if isinstance(each, ast.Name | ast.Attribute | ast.Subscript) and not isinstance(each.ctx, ast.Load):
                self.stored.add(_dotted(each))
        return True

    def changes(self, condition: ast.expr) -> bool:
        """Return whether the turn changes a variable of a condition."""
        names = {_dotted(each) for each in ast.walk(condition) if isinstance(each, ast.Name | ast.Attribute)}
        return any(f"{name}.".startswith(f"{each}.") for name in names for each in self.stored)


def _dotted(node: ast.expr) -> str:
    """Return the variable of an expression such as `self.a.b`; for an item, that is its container."""
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        return f"{_dotted(node.value)}.{node.attr}"
    return _dotted(node.value) if isinstance(node, ast.Subscript | ast.Starred) else ""


# -- turning -----------------------------------------------------------------------------------------------------------


@dataclass(slots=True)
class BusyWait:
    """A loop that waited without a sleep.

    Attributes:
        who: the node or the application.
        file, line: its place.
        at_ns: virtual time at which it first used time.
        used_ns: virtual CPU time that it used.
    """

    who: str
    file: str
    line: int
    at_ns: int
    used_ns: int = 0

    def __str__(self) -> str:
        """Return a line for the report of a run."""
        place = f"{os.path.basename(self.file)}:{self.line}"
        return (
            f"{self.who}: the loop at {place} waits without a sleep, and used {self.used_ns / NS_PER_S:.3f} s of CPU "
            "time; sleep in the loop (rospy.sleep(0.01)), or wait for a threading.Event"
        )


def turn_hook(
    kernel: Kernel, turn_ns: int, who: Callable[[], str], traps: list[object]
) -> Callable[[tuple[str, int]], None]:
    """Return the hook for the code of a node or an application.

    Args:
        kernel: the kernel of its tasks.
        turn_ns: virtual CPU time of a turn in ns; with 0 a turn never takes time.
        who: returns the name for the report.
        traps: gets a `BusyWait` for each loop that uses time.
    """
    seen: dict[int, _Seen] = {}  # by task

    def turns(place: tuple[str, int]) -> None:
        task = kernel.current
        last = seen.get(task.ident)
        if last is None or last.cpu_ns != task.cpu_ns or last.now_ns != kernel.now:
            if last is None and len(seen) >= MOST_TASKS:
                seen.clear()
            seen[task.ident] = _Seen(task.cpu_ns, kernel.now)
            return
        last.turns = count = last.turns + 1
        if count <= FREE_TURNS or not turn_ns or task is kernel.host:
            return
        spent_ns = turn_ns if count <= FREE_TURNS + FINE_TURNS else max(turn_ns, COARSE_NS)
        _wait_of(who(), place, kernel.now, traps).used_ns += spent_ns
        kernel.compute(spent_ns)
        last.cpu_ns, last.now_ns = task.cpu_ns, kernel.now

    return turns


def _wait_of(who: str, place: tuple[str, int], now_ns: int, traps: list[object]) -> BusyWait:
    """Return the record of a loop, added at its first turn."""
    for each in traps:
        if isinstance(each, BusyWait) and (each.who, each.file, each.line) == (who, *place):
            return each
    made = BusyWait(who, *place, now_ns)
    traps.append(made)
    return made


@dataclass(slots=True)
class _Seen:
    """The virtual times of a task at its last turn, and the number of turns since it last did something."""

    cpu_ns: int
    now_ns: int
    turns: int = 0
