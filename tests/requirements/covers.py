"""Which requirement a test is about: its own name says the first id, `covers` says all of them."""

from __future__ import annotations

from collections.abc import Callable
from typing import TypeVar

Test = TypeVar("Test", bound=Callable[..., object])


def covers(*ids: str) -> Callable[[Test], Test]:
    """Mark a test as evidence for requirement ids such as "cES1005.1"; the tests' sources are read for it."""

    def mark(test: Test) -> Test:
        return test

    return mark
