"""Misspelt keyword arguments in tests, reported with the nearest known one."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from inspect import signature
from typing import ParamSpec, TypeVar

from cfepy.reading.suggestions import expected
from cfepy.status import UsageError, together

P = ParamSpec("P")
T = TypeVar("T")


def suggests_keywords(function: Callable[P, T]) -> Callable[P, T]:
    """Return the function with a check of its keyword arguments.

    Args:
        function: a function without `**`. The returned one raises a UsageError about all its unknown keywords.
    """
    known = [name for name in signature(function).parameters if name != "self"]

    @wraps(function)
    def checked(*args: P.args, **given: P.kwargs) -> T:
        unknown = [name for name in given if name not in known]
        if unknown:
            hints = [(name, expected(name, known)) for name in unknown]
            raise together([UsageError(f"unknown argument; {hint}", field=name) for name, hint in hints])
        return function(*args, **given)

    return checked
