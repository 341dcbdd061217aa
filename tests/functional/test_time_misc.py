"""Times as text (time_misc_test.c)."""

from __future__ import annotations

import pytest

from cfepy.app import Cfe

DAY = 86400


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (0, "1980-001-00:00:00.00000"),
        (365 * DAY, "1980-366-00:00:00.00000"),
        (366 * DAY, "1981-001-00:00:00.00000"),
    ],
)
def test_time_print(cfe: Cfe, seconds: int, text: str) -> None:
    assert cfe.time.print_((seconds, 0)) == text
