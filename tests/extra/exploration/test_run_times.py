"""Which task had the processor at which time."""

from __future__ import annotations

from pathlib import Path

from cfepy.extra.exploration.run_times import RunTimes
from cfepy.pilot import RunPlan, fly
from tests.extra.exploration import missions

BUSY = """
    import cfepy
    import rospy

    rospy.init_node("busy")
    while not rospy.is_shutdown():
        cfepy.compute(0.02)
        rospy.sleep(0.03)
"""


def test_turns_add_up_to_the_computed_time(tmp_path: Path) -> None:
    times = RunTimes()
    fly(RunPlan((str(missions.write(tmp_path, {"BUSY": BUSY})),), seconds=1.0), attachments=[times])
    assert abs(times.between(600_000_000, 1_000_000_000)["BUSY"] - 160_000_000) < 100_000
    first = next(turn for turn in times.turns if turn.to_ns - turn.from_ns > 10_000_000)
    middle = (first.from_ns + first.to_ns) // 2
    assert times.between(middle, first.to_ns)["BUSY"] == first.to_ns - middle
    assert times.between(first.to_ns, first.to_ns + 1_000_000)["BUSY"] == 0
