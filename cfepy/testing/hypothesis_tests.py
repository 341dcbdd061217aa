"""Tests with @given: each example has its own missions, and a failing one can be passed on as a code.

Hypothesis is not loaded here before a test uses it.
"""

from __future__ import annotations

import functools
import re
from collections.abc import Callable, Iterator
from typing import Any

import pytest

from cfepy.status import UsageError

__tracebackhide__ = True  # pytest shows the line of the test

_CODE = re.compile(r"@reproduce_failure\((['\"])(?P<version>[^'\"]+)\1, b(['\"])(?P<code>.*?)\3\)")


class ExampleTests:
    """Support for tests with @given.

    Args:
        code: code of the only example to run, as from `code_of`; None runs them as Hypothesis does.
        end_example: called at the end of an example, with whether it has failed.
    """

    def __init__(self, code: str | None, end_example: Callable[[bool], object]) -> None:
        self._code = code
        self._end_example = end_example

    def concerns(self, item: pytest.Item) -> bool:
        """Return whether a test has examples."""
        return bool(getattr(getattr(item, "obj", None), "is_hypothesis_test", False))

    def prepare(self, item: pytest.Item) -> None:
        """Prepare a test.

        Raises:
            UsageError: if `code` is invalid.
        """
        if not self.concerns(item):
            return
        from hypothesis import reproduce_failure, settings

        test: Any = item.obj  # type: ignore[attr-defined]
        function = getattr(test, "__func__", test)
        function._hypothesis_internal_use_settings = settings(
            function._hypothesis_internal_use_settings, print_blob=True
        )
        inner = function.hypothesis.inner_test
        if not hasattr(inner, "_cfepy_ends"):
            function.hypothesis.inner_test = self._ending(inner)
        if self._code is not None:
            version, colon, code = self._code.partition(":")
            if not colon:
                raise UsageError(
                    "not a valid example; copy the string printed with the failure", field="--cfepy-example"
                )
            reproduce_failure(version, code.encode())(function)

    def _ending(self, inner: Callable[..., Any]) -> Callable[..., Any]:
        """Return the test's own function, ending its missions after each example."""

        @functools.wraps(inner)
        def example(*args: Any, **kwargs: Any) -> Any:
            failed = True
            try:
                result = inner(*args, **kwargs)
                failed = False
                return result
            finally:
                self._end_example(failed)

        example._cfepy_ends = True  # type: ignore[attr-defined]
        return example

    def code_of(self, error: BaseException) -> str | None:
        """Return the code of the failed example; None if there is none, as for an error in the strategies."""
        for note in _notes(error):
            found = _CODE.search(note)
            if found is not None:
                return f"{found['version']}:{found['code']}"
        return self._code  # Hypothesis does not report the one that it was given


def _notes(error: BaseException) -> Iterator[str]:
    yield from getattr(error, "__notes__", ())
    if isinstance(error, BaseExceptionGroup):
        for each in error.exceptions:
            yield from _notes(each)
