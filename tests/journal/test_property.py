"""With any mission, seed, schedule, board and length, a journal reproduces the run."""

from __future__ import annotations

from pathlib import Path
from tempfile import TemporaryDirectory

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.journal.missions import SMALL
from tests.journal.replays import assert_replays, plan_for

schedules = st.one_of(
    st.just("fifo"),
    st.builds("random:{}".format, st.integers(0, 99)),
    st.builds("random:{}:any".format, st.integers(0, 99)),
    st.builds("pct:{}:{}:400".format, st.integers(0, 99), st.integers(1, 5)),
    st.dictionaries(st.integers(0, 200), st.integers(1, 3), min_size=1, max_size=5).map(
        lambda choices: "at:" + ",".join(f"{decision}={choice}" for decision, choice in choices.items())
    ),
)


@pytest.mark.slow
@settings(max_examples=12, deadline=None, suppress_health_check=[HealthCheck.too_slow])
@given(
    mission=st.sampled_from(["lab", "capture", *SMALL]),
    seconds=st.floats(0.05, 1.0),
    seed=st.integers(0, 1000),
    board=st.sampled_from(["linux", "workstation", "rx64m"]),
    schedule=schedules,
)
def test_journal_reproduces_the_run(mission: str, seconds: float, seed: int, board: str, schedule: str) -> None:
    with TemporaryDirectory() as name:
        folder = Path(name, "mission")
        folder.mkdir()
        where = SMALL[mission](folder) if mission in SMALL else mission
        assert_replays(plan_for(where, seconds, seed=seed, board=board, schedule=schedule), Path(name))
