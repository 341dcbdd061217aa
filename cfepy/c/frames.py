"""Frames of Python that look like frames of C, so that tracebacks, the stall watch and debuggers show lines of C."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from types import CodeType, FunctionType

from cfepy.c.places import Place

Watch = Callable[[float, int], object]
"""Called with the seconds for which C code has computed without a call, and the address to which that returned."""


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
        place = self._place_of(address)
        if place is None or not place.file:
            return self._watch
        function: Watch = FunctionType(_code(place.function, place.file, place.line), {"watch": self._watch})
        self[address] = function
        return function


def _frame(computed_s: float, called_from: int) -> object:
    return watch(computed_s, called_from)  # type: ignore[name-defined]  # noqa: F821


@lru_cache(512)
def _code(function: str, file: str, line: int) -> CodeType:
    """The code of `_frame`, whose one line is the line after its first."""
    return _frame.__code__.replace(co_name=function, co_qualname=function, co_filename=file, co_firstlineno=line - 1)
