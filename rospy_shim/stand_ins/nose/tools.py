"""nose.tools: decorators for tests, and unittest's assertions as functions, with and without camel case."""

from __future__ import annotations

import functools
import re
import unittest
from collections.abc import Callable
from typing import Any

_Test = Callable[..., Any]
_CASE = unittest.FunctionTestCase(lambda: None)
_RENAMED = {"assertRegexpMatches": "assertRegex", "assertItemsEqual": "assertCountEqual"}  # since Python 2


def __getattr__(name: str) -> Any:
    """Return an assertion: `assert_raises_regex` is unittest's assertRaisesRegex.

    Raises:
        AttributeError: there is no such assertion.
    """
    camel = re.sub("_([a-z])", lambda match: match[1].upper(), name)
    camel = _RENAMED.get(camel, camel)
    if not camel.startswith("assert") or not hasattr(_CASE, camel):
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    return getattr(_CASE, camel)


def ok_(expr: object, msg: str | None = None) -> None:
    """Fail with `msg` unless `expr` is true."""
    if not expr:
        raise AssertionError(msg)


def eq_(a: object, b: object, msg: str | None = None) -> None:
    """Fail unless both are equal."""
    if a != b:
        raise AssertionError(msg or f"{a!r} != {b!r}")


def istest(func: _Test) -> _Test:
    """Mark a function as a test regardless of its name."""
    func.__test__ = True  # type: ignore[attr-defined]
    return func


def nottest(func: _Test) -> _Test:
    """Mark a function as not a test regardless of its name."""
    func.__test__ = False  # type: ignore[attr-defined]
    return func


def raises(*exceptions: type[BaseException]) -> Callable[[_Test], _Test]:
    """Decorate a test so that it passes if it raises one of these."""

    def decorate(func: _Test) -> _Test:
        @functools.wraps(func)
        def test(*args: Any, **options: Any) -> None:
            try:
                func(*args, **options)
            except exceptions:
                return
            names = " or ".join(each.__name__ for each in exceptions)
            raise AssertionError(f"{func.__name__}() did not raise {names}")

        return test

    return decorate


def with_setup(setup: _Test | None = None, teardown: _Test | None = None) -> Callable[[_Test], _Test]:
    """Decorate a test function with steps before and after it."""

    def decorate(func: _Test) -> _Test:
        @functools.wraps(func)
        def test(*args: Any, **options: Any) -> None:
            if setup is not None:
                setup()
            try:
                func(*args, **options)
            finally:
                if teardown is not None:
                    teardown()

        return test

    return decorate
