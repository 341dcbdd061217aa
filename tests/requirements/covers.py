"""The requirements of a test: its own name has the first id, `covers` has all of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

Test = TypeVar("Test", bound=Callable[..., object])


def covers(*ids: str) -> Callable[[Test], Test]:
    """Mark a test as evidence for requirement ids such as "cES1005.1", which are read from the tests' sources."""

    def mark(test: Test) -> Test:
        return test

    return mark
