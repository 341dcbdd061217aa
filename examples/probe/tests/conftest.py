"""What all tests of the probe share."""

from __future__ import annotations

import pytest

from cfepy.testing import Flight, Missions


@pytest.fixture
def probe(mission: Missions) -> Flight:
    """The probe, up and running."""
    flight = mission("../mission")
    flight.run_until_operational()
    return flight
