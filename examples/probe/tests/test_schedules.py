"""Whoever goes first: the total is right under every schedule."""

from __future__ import annotations

import pytest

from cfepy.testing import Flight, explore


@explore(seeds=10, policy=["random", "pct"])
@pytest.mark.parametrize("messages", [1, 3])
def test_nothing_is_lost(probe: Flight, messages: int) -> None:
    for _ in range(messages):
        probe.publish("/add", data=1.0)
    probe.expect_message("/count", number=messages, total=float(messages), within=0.5)
