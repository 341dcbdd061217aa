"""Three nodes that fly for long: no arena grows, nothing is lost, and housekeeping has the counters of the rates."""

from __future__ import annotations

from pathlib import Path

import pytest

from dev.roscfe.building import needs_cpp
from dev.roscfe.endurance import fly

pytestmark = [pytest.mark.slow, needs_cpp]
TIMES_S = (150.0, 750.0)
"""Behind two minutes each node has done all that it does."""


def test_nodes_that_fly_for_long_keep_no_memory(tmp_path: Path) -> None:
    early, late = fly(tmp_path, list(TIMES_S))
    seconds = int(TIMES_S[1] - TIMES_S[0])
    for name, values in late.items():
        assert values.arena_used == early[name].arena_used, name
        assert (values.dropped, values.bad, values.not_sent) == (0, 0, 0), name
    # guard hears odom and tf, and watch hears odom and seen, each once a second.
    for name in ("guard", "watch"):
        assert abs(late[name].received - early[name].received - 2 * seconds) <= 2, name
    assert late["drive"].received == 0
