"""examples/arm: two nodes in C++ close a loop at 1 kHz beside HK, which a third node observes and commands."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

import pytest

import cfepy
from dev.roscfe.building import needs_cpp

pytestmark = [needs_cpp, pytest.mark.slow]
ARM = Path(__file__).parents[3] / "examples/arm/mission"
SAID = (
    "5000 states in 5.000 s, 1000.0 Hz; 5000 commands came",
    "5000 commands in 5.000 s, 1000.0 Hz; 5000 states came",
    "capture complete: largest joint error 0.000000 rad",
    # HK has had the no-op of a node, and collects from the arm.
    "packet 5 of HK: HK has 1 commands, arm at sample 4000, peak current 0.456 A",
)


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_loop_at_1_khz_loses_no_messages(tasks: str) -> None:
    run = cfepy.run(str(ARM), seconds=7, tasks=tasks)
    lines = [line.partition("]: ")[2] for line in run.console]
    assert [text for text in SAID if text not in lines] == []
    for name in ("/joint_states", "/motor_command"):
        times = run.topic(name).times_ns
        assert len(times) == 5000
        cycles = [after - before for before, after in pairwise(times)][2:]  # the first two begin with the nodes
        assert max(abs(cycle - 1_000_000) for cycle in cycles) <= 5_000
