"""Statuses as text (es_error_test.c)."""

from __future__ import annotations

import pytest

from cfepy.app import Cfe
from cfepy.status import CFE_SUCCESS

SEVERITY_ERROR = 0xC0000000 - (1 << 32)


@pytest.mark.parametrize(
    ("status", "text"),
    [
        (CFE_SUCCESS, "0x00000000"),
        (SEVERITY_ERROR, "0xc0000000"),
        ((1 << 31) - 1, "0x7fffffff"),
        (-(1 << 31), "0x80000000"),
    ],
)
def test_status_to_string(cfe: Cfe, status: int, text: str) -> None:
    assert cfe.es.status_to_string(status) == text
