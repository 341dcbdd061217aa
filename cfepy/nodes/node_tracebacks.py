"""Tracebacks of nodes, as the author of a node expects them: lines of the node and its libraries, without lines of the
simulator.
"""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Any

from cfepy.interpreter.own_code import source_file

if TYPE_CHECKING:
    from traceback import TracebackException

_PACKAGE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
# active while a node loads messages
_MESSAGES = os.path.join(os.path.dirname(_PACKAGE), "rospy_shim", "types", "msgs", "")
_CFEPY = os.path.join(_PACKAGE, "")
_ROSPY = tuple(
    os.path.join(os.path.dirname(_PACKAGE), "rospy_shim", each) for each in ("runtime.py", "client", "graph")
)
_HIDDEN = (
    *(os.path.join(_PACKAGE, each, "") for each in ("interpreter", "nodes", "rtos", "schedules")),
    _MESSAGES,
    "<frozen importlib",
)


def is_hidden(file: str) -> bool:
    """Return whether a source file belongs to the simulator."""
    return source_file(file).startswith(_HIDDEN)


def traceback_text(error: BaseException) -> str:
    """Return the traceback of an error as Python prints it, without the simulator's frames."""
    return "".join(traceback_parts(error))


def traceback_parts(error: BaseException) -> list[str]:
    """As `traceback_text`, a text for each frame (traceback.format_exception)."""
    from traceback import TracebackException

    report = TracebackException(type(error), error, error.__traceback__)
    strip(report, is_hidden)
    if isinstance(error, SyntaxError) and not report.stack:
        report.stack = None  # type: ignore[assignment]  # of the program itself: Python prints no heading
    return list(report.format())


def strip(report: TracebackException, hidden: Callable[[str], bool]) -> None:
    """Remove the frames of hidden source files from a traceback and those of its causes."""
    waiting, seen = [report], {id(report)}
    while waiting:
        each = waiting.pop()
        each.stack[:] = [frame for frame in each.stack if not hidden(frame.filename)]
        for inner in (each.__cause__, each.__context__, *(each.exceptions or ())):
            if inner is not None and id(inner) not in seen:
                seen.add(id(inner))
                waiting.append(inner)


def hide_in(module: Any) -> None:
    """Make a node's own copy of the module `traceback` leave out the simulator's frames."""
    for name in ("walk_tb", "_walk_tb_with_full_positions"):
        if hasattr(module, name):
            setattr(module, name, _without_hidden(getattr(module, name)))
    module.walk_stack = _own_stack(module.walk_stack)


def _without_hidden(walker: Callable[[Any], Iterable[Any]]) -> Callable[[Any], Iterator[Any]]:
    def walk(start: Any) -> Iterator[Any]:
        for step in walker(start):
            if not is_hidden(step[0].f_code.co_filename):
                yield step

    return walk


def _own_stack(walker: Callable[[Any], Iterable[Any]]) -> Callable[[Any], Iterator[Any]]:
    """`walk_stack` up to the node's outermost frame; the frames below it differ between threads and greenlets."""

    def walk_stack(start: Any) -> Iterator[Any]:
        if start is None:  # the caller of the function that walks the frames, as in the original
            start = sys._getframe().f_back.f_back.f_back.f_back  # type: ignore[union-attr]
        steps = [step for step in walker(start) if not step[0].f_code.co_filename.startswith(_CFEPY)]
        while steps and steps[-1][0].f_code.co_filename.startswith(_ROSPY):
            steps.pop()
        yield from steps

    return walk_stack
