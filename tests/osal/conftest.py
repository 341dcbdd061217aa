"""OSAL tests get a fresh Osal each."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from tests.osal.helpers import Bench


@pytest.fixture
def bench() -> Iterator[Bench]:
    """A kernel and an Osal, shut down after the test."""
    made = Bench()
    with made.kernel:
        yield made
