"""Tracebacks as the author of a node expects them: the node's lines and the libraries', nothing of the simulator."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from traceback import TracebackException

_PACKAGE = os.path.dirname(os.path.dirname(os.path.abspath(__file__)))
_HIDDEN = (os.path.join(_PACKAGE, "nodes", ""), os.path.join(_PACKAGE, "rtos", ""), "<frozen importlib")


def is_hidden(file: str) -> bool:
    """Whether a source file belongs to the machinery below a node."""
    return file.startswith(_HIDDEN)


def traceback_text(error: BaseException) -> str:
    """The traceback of an error as Python prints it, without the simulator's frames."""
    from traceback import TracebackException

    report = TracebackException(type(error), error, error.__traceback__)
    _strip(report, set())
    return "".join(report.format())


def _strip(report: TracebackException | None, seen: set[int]) -> None:
    if report is None or id(report) in seen:
        return
    seen.add(id(report))
    report.stack[:] = [frame for frame in report.stack if not is_hidden(frame.filename)]
    _strip(report.__cause__, seen)
    _strip(report.__context__, seen)
    for inner in getattr(report, "exceptions", None) or ():
        _strip(inner, seen)


def hide_in(module: Any) -> None:
    """Make a node's own copy of the module `traceback` leave out the simulator's frames."""
    for name in ("walk_tb", "_walk_tb_with_full_positions"):
        if hasattr(module, name):
            setattr(module, name, _without_hidden(getattr(module, name)))


def _without_hidden(walker: Callable[[Any], Iterable[Any]]) -> Callable[[Any], Iterator[Any]]:
    def walk(start: Any) -> Iterator[Any]:
        for step in walker(start):
            if not is_hidden(step[0].f_code.co_filename):
                yield step

    return walk
