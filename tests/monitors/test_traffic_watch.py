"""Rates and latencies of messages on the bus."""

from __future__ import annotations

from cfepy.monitors.traffic_watch import Arrivals
from cfepy.units import NS_PER_S


def test_rate_falls_when_messages_stop_before_the_end() -> None:
    found = Arrivals()
    for each in range(11):
        found.add(0, each * NS_PER_S // 10)
    assert found.rate_hz(NS_PER_S) == 10.0
    assert found.rate_hz(4 * NS_PER_S) == 2.5
