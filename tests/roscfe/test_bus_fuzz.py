"""Damaged packets of each kind that the library reads from the bus: none ends the node, under the sanitizers.

`python -m dev.roscfe.fuzz` flies over a million packets of each kind.
"""

from __future__ import annotations

import pytest

from cfepy.extra.convert.message_headers import Profile
from dev.roscfe.building import needs_cpp
from dev.roscfe.fuzz.corpus import AREAS
from dev.roscfe.fuzz.flying import Driver, faults

pytestmark = [pytest.mark.slow, needs_cpp]
PACKETS = 20_000
LEAST_ACCEPTED = 500
"""Packets, of an area, that are what they should be: enough to reach the code behind the checks."""


@pytest.fixture(scope="module")
def driver(tmp_path_factory: pytest.TempPathFactory) -> Driver:
    return Driver(tmp_path_factory.mktemp("fuzz"), Profile.HOST)


@pytest.mark.parametrize("area", AREAS)
def test_damaged_packets_do_not_end_the_node(driver: Driver, area: str) -> None:
    flight = driver.fly(area, PACKETS)
    assert faults(flight) == []
    assert flight.figures["packets"] == PACKETS
    assert flight.figures["accepted"] > LEAST_ACCEPTED
    if area in ("topics", "transforms"):
        assert flight.figures["bad"] > LEAST_ACCEPTED


def test_seed_decides_all_packets(driver: Driver) -> None:
    first, second, other = (driver.fly("services", 2000, seed) for seed in (5, 5, 6))
    assert first == second
    assert first.digest != other.digest
