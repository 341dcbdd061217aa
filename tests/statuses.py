"""The status with which a call fails, for tests."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cfepy.status import CfeError


def status_of(call: Callable[..., object], *arguments: object) -> int:
    """Return the status of a call that must fail."""
    with pytest.raises(CfeError) as caught:
        call(*arguments)
    return caught.value.status
