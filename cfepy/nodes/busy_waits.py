"""Loops that wait for another task without a sleep: `while not self.image: pass`.

On a real computer such a loop uses its processor while other threads run. Here computing takes no virtual time, so no
other task would ever run. Therefore the code of nodes and applications gets a hook in each loop that can wait. From the
1001st turn in a row in which the task used no virtual time, the hook uses some, so other tasks run. Only turns count,
not wall time, so every run is the same.

A loop gets the hook if a turn can pass that changes nothing in at least one of the conditions that it checks. A loop
that computes changes its own conditions; `while True: pass` has none, and the stall watch ends it. A method may change
its object, and a function its arguments, so `while heap: heappop(heap)` computes. No hook is needed in a loop that
always sleeps, or asks for the shutdown.
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
COARSE_NS = 100_000  # time of each later turn without calls: CPython switches between threads every 5 ms
MOST_SEEN = 64  # loops of tasks whose turns are counted at a time
_GIVES_WAY = ast.Await | ast.Yield | ast.YieldFrom
# fmt: off
_PURE = frozenset({
    "abs", "all", "any", "bool", "float", "int", "isinstance", "len", "max", "min", "print", "round", "str", "sum",
    "tuple",
})
# fmt: on
_ADVANCES = frozenset({"is_shutdown", "sleep", "spin", "spin_once", "wait"})
"""Names of functions that always use virtual time."""


# -- finding -----------------------------------------------------------------------------------------------------------


BusyPlace = tuple[str, int, bool]
"""File and line of a loop with a hook, and whether a turn that waits makes no calls."""


def busy_loops(tree: ast.Module) -> list[tuple[ast.While, bool]]:
    """Return the loops of a module that can wait, and whether such a turn makes no calls."""
    found = []
    for node in ast.walk(tree):
        if isinstance(node, ast.While):
            turn = _Turn()
            if turn.waits_in(node):
                found.append((node, not turn.calls))
    return found


def add_hooks(loops: Iterable[tuple[ast.While, bool]], file: str) -> None:
    """Let each turn of some loops call the hook with the file and the line of the loop."""
    for loop, is_inert in loops:
        place = ast.Tuple([ast.Constant(each) for each in (file, loop.lineno, is_inert)], ast.Load())
        call = ast.Expr(ast.Call(ast.Name(HOOK, ast.Load()), [place], []))
        for node in ast.walk(call):
            if isinstance(node, ast.expr | ast.stmt):
                ast.copy_location(node, loop)
                node.end_lineno, node.end_col_offset = loop.lineno, loop.col_offset
        loop.body.insert(0, call)


class _Turn:
    """One turn of a loop that does not leave it.

    Attributes:
        conditions: the parts of the conditions that it checks, without constants.
        changed: the variables, as dotted names, that it may change.
        calls: whether it calls anything but Python's own functions that only look.
    """

    def __init__(self) -> None:
        self.conditions: list[ast.expr] = []
        self.changed: set[str] = set()
        self.calls = False

    def waits_in(self, loop: ast.While) -> bool:
        """Return whether the turn waits in a loop: whether it may be one of many that do nothing."""
        self._check(loop.test)
        if any(isinstance(each, _GIVES_WAY) or _called(each) in _ADVANCES for each in ast.walk(loop.test)):
            return False
        return self._passes(loop.body) and any(not self._changes(each) for each in self.conditions)

    def _check(self, test: ast.expr) -> None:
        """Add a condition, or a value that may raise an error."""
        if isinstance(test, ast.BoolOp):
            for each in test.values:
                self._check(each)
        elif isinstance(test, ast.UnaryOp) and isinstance(test.op, ast.Not):
            self._check(test.operand)
        elif not isinstance(test, ast.Constant):
            self.conditions.append(test)
            for node in ast.walk(test):
                if isinstance(node, ast.NamedExpr):
                    self.changed.add(node.target.id)
                self.calls |= isinstance(node, ast.Call) and _called(node) not in _PURE

    def _passes(self, block: list[ast.stmt]) -> bool:
        """Return whether the turn can pass through a block; adds its conditions and changes."""
        for node in block:
            if isinstance(node, ast.Continue):
                return True
            if isinstance(node, ast.If):
                self._check(node.test)
                if not self._passes_one_of(node.body, node.orelse):
                    return False
            elif isinstance(node, ast.Try):
                if not self._passes_try(node):
                    return False
            elif not self._does(node):
                return False
        return True

    def _passes_one_of(self, *branches: list[ast.stmt]) -> bool:
        """Return whether the turn can pass through one of several branches; adds the effects of a branch that does
        nothing, or else of all branches.
        """
        inside = [(turn, turn._passes(branch)) for turn, branch in ((_Turn(), branch) for branch in branches)]
        passed = [turn for turn, passes in inside if passes]
        idle = [turn for turn in passed if not (turn.changed or turn.calls)]
        for turn in idle or passed:
            self.conditions += turn.conditions
            self.changed |= turn.changed
            self.calls |= turn.calls
        return bool(passed)

    def _passes_try(self, node: ast.Try) -> bool:
        """Return whether the turn can pass through a `try`, or through a handler, because the block still fails."""
        if self._passes_one_of([*node.body, *node.orelse, *node.finalbody]):
            return True
        for statement in node.body:
            if isinstance(statement, ast.Expr | ast.Assign | ast.Return) and statement.value is not None:
                self._check(statement.value)
        return self._passes_one_of(*([*handler.body, *node.finalbody] for handler in node.handlers))

    def _does(self, node: ast.stmt) -> bool:
        """Return whether the turn can do a statement and go on without a sleep; adds the names that it changes."""
        if not isinstance(node, ast.Pass | ast.Expr | ast.Assign | ast.AnnAssign | ast.AugAssign | ast.For | ast.While):
            return False
        for each in ast.walk(node):
            if isinstance(each, _GIVES_WAY | ast.Return | ast.Raise) or _called(each) in _ADVANCES:
                return False
            if isinstance(each, ast.Name | ast.Attribute | ast.Subscript) and not isinstance(each.ctx, ast.Load):
                self.changed.add(_dotted(each))
            if isinstance(each, ast.Call) and _called(each) not in _PURE:
                self.calls = True
                receiver = [each.func.value] if isinstance(each.func, ast.Attribute) else []
                self.changed.update(filter(None, map(_dotted, [*receiver, *each.args])))
        return True

    def _changes(self, condition: ast.expr) -> bool:
        """Return whether the turn may change a variable of a condition."""
        names = {_dotted(each) for each in ast.walk(condition) if isinstance(each, ast.Name | ast.Attribute)}
        return any(f"{name}.".startswith(f"{each}.") for name in names for each in self.changed)


def _called(node: ast.AST) -> str:
    """Return the name of the called function or method; empty if the node is no such call."""
    if not isinstance(node, ast.Call):
        return ""
    function = node.func
    return (
        function.attr if isinstance(function, ast.Attribute) else function.id if isinstance(function, ast.Name) else ""
    )


def _dotted(node: ast.expr) -> str:
    """Return the variable of an expression such as `self.a.b`; for an item, its container; for others, nothing."""
    if isinstance(node, ast.Name):
        return node.id
    if isinstance(node, ast.Attribute):
        inner = _dotted(node.value)
        return f"{inner}.{node.attr}" if inner else ""
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


def turn_hook(kernel: Kernel, turn_ns: int, who: Callable[[], str], traps: list[object]) -> Callable[[BusyPlace], None]:
    """Return the hook for the code of a node or an application.

    Args:
        kernel: the kernel of its tasks.
        turn_ns: virtual CPU time of a turn in ns; with 0 a turn never takes time.
        who: returns the name for the report.
        traps: gets a `BusyWait` for each loop that uses time.
    """
    seen: dict[tuple[int, BusyPlace], _Seen] = {}  # by task and loop

    def turns(place: BusyPlace) -> None:
        task = kernel.current
        last = seen.get((task.ident, place))
        if last is None or last.cpu_ns != task.cpu_ns or last.now_ns != kernel.now:
            if last is None and len(seen) >= MOST_SEEN:
                seen.clear()
            seen[task.ident, place] = _Seen(task.cpu_ns, kernel.now)
            return
        last.turns = count = last.turns + 1
        if count <= FREE_TURNS or not turn_ns or task is kernel.host:
            return
        file, line, is_inert = place
        spent_ns = max(turn_ns, COARSE_NS) if is_inert and count > FREE_TURNS + FINE_TURNS else turn_ns
        _wait_of(who(), file, line, kernel.now, traps).used_ns += spent_ns
        kernel.compute(spent_ns)
        last.cpu_ns, last.now_ns = task.cpu_ns, kernel.now

    return turns


def _wait_of(who: str, file: str, line: int, now_ns: int, traps: list[object]) -> BusyWait:
    """Return the record of a loop, added at its first turn."""
    for each in traps:
        if isinstance(each, BusyWait) and (each.who, each.file, each.line) == (who, file, line):
            return each
    made = BusyWait(who, file, line, now_ns)
    traps.append(made)
    return made


@dataclass(slots=True)
class _Seen:
    """The virtual times of a task at its last turn of a loop, and the number of turns since it used virtual time."""

    cpu_ns: int
    now_ns: int
    turns: int = 0
