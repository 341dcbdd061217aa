"""Frames of Python that look like frames of C, so that tracebacks, the stall watch and debuggers show lines of C."""

from __future__ import annotations

import ast
from collections.abc import Callable
from functools import lru_cache
from types import CodeType, FunctionType
from typing import NoReturn

from cfepy.c.places import Place

Watch = Callable[[float, int], object]
"""Called with the seconds for which C code has computed without a call, and the address to which that returned."""


Call = Callable[..., object]
"""Called with a function and its arguments; calls it."""


class PreemptedFrames(dict[int, Watch]):
    """What the engine calls when C code has computed for a while without a call, by the address where it was.

    Each is a function that is seen as the place of that address: Python code that looks at the thread, such as the
    stall watch, finds it there.

    Args:
        place_of: the place of an address, if it is known.
        watch: what each of them calls.
    """

    def __init__(self, place_of: Callable[[int], Place | None], watch: Watch) -> None:
        super().__init__()
        self._place_of = place_of
        self._watch = watch

    def __missing__(self, address: int) -> Watch:
        function: Watch = _seen_as(self._place_of(address), _WATCH, {"watch": self._watch}) or self._watch
        self[address] = function
        return function


def _call(function: Call, *args: object) -> object:
    return function(*args)


class CallFrames(dict[int, Call]):
    """What the engine calls a function of the API through, by the address of the call, for tools that look at frames.

    Args:
        place_of: the place of an address, if it is known.
    """

    def __init__(self, place_of: Callable[[int], Place | None]) -> None:
        super().__init__()
        self._place_of = place_of

    def __missing__(self, address: int) -> Call:
        function: Call = _seen_as(self._place_of(address), _CALL, {}) or _call
        self[address] = function
        return function


def raise_at(place: Place | None, error: BaseException) -> NoReturn:
    """Raise an error from a frame that is seen as a place of C, without what came before it.

    Raises:
        BaseException: the error.
    """
    function = _seen_as(place, _RAISE, {})
    if function is not None:
        function(error)
    raise error from None


def _seen_as(place: Place | None, code: CodeType, names: dict[str, object]) -> FunctionType | None:
    """A function of this code that is seen as a place; None for a place that is not known."""
    if place is None or not place.file:
        return None
    return FunctionType(_renamed(code, place.function, place.file, place.line), names)


@lru_cache(1024)
def _renamed(code: CodeType, function: str, file: str, line: int) -> CodeType:
    return code.replace(co_name=function, co_qualname=function, co_filename=file, co_firstlineno=line)


def _code(source: str) -> CodeType:
    """The code of a function, all of it on its first line, and as wide as that: tracebacks mark no part of the line."""
    tree = ast.parse(source)
    for node in ast.walk(tree):
        if isinstance(node, ast.expr | ast.stmt | ast.arg):
            node.lineno, node.col_offset, node.end_lineno, node.end_col_offset = 1, 0, 2, 0
    [function] = (each for each in compile(tree, "", "exec").co_consts if isinstance(each, CodeType))
    return function


_WATCH = _code("def frame(computed_s, called_from): return watch(computed_s, called_from)")
_CALL = _code("def frame(function, *args): return function(*args)")
_RAISE = _code("def frame(error): raise error from None")
