"""OSAL tests get a fresh Osal each."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

from cfepy.config.platform import PlatformConfig
from tests.osal.helpers import Bench


@pytest.fixture
def bench() -> Iterator[Bench]:
    """A kernel and an Osal, shut down after the test."""
    made = Bench()
    with made.kernel:
        yield made


@pytest.fixture
def safe_bench() -> Iterator[Bench]:
    """The same for a safe mission."""
    made = Bench(config=PlatformConfig(safe=True))
    with made.kernel:
        yield made
