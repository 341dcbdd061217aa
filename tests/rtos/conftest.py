"""Kernel tests run on both task contexts."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import partial

import pytest

from cfepy.rtos import Kernel
from cfepy.trace import Trace
from tests.rtos.helpers import Log


@pytest.fixture(params=["thread", "greenlet"])
def context(request: pytest.FixtureRequest) -> str:
    """The name of a task context."""
    if request.param == "greenlet":
        pytest.importorskip("greenlet")
    return str(request.param)


@pytest.fixture
def make_kernel(context: str) -> Callable[..., Kernel]:
    """Makes kernels on the context under test."""
    return partial(Kernel, context)


@pytest.fixture
def kernel(context: str) -> Iterator[Kernel]:
    """A kernel that is shut down after the test."""
    with Kernel(context, Trace()) as made:
        yield made


@pytest.fixture
def log() -> Log:
    """An empty log."""
    return Log()
