"""Connection delays are explored like the order of tasks: each policy draws them, and they are replayed and shrunk."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import pytest

from cfepy.extra.exploration import Expedition, Report
from cfepy.pilot import RunPlan
from cfepy.schedules import Schedule

SCRIPT = "".join(f"CFE_APP, {app.lower()}.py, __main__, {app}, 100, 16384, 0x0, 1;\n" for app in ("BASE", "ARM", "EYE"))
BASE = """
    import rospy
    from std_msgs.msg import Bool
    rospy.init_node("base")
    enable = rospy.Publisher("enable", Bool, queue_size=1)
    rospy.sleep(0.1)
    enable.publish(True)
    rospy.spin()
"""
ARM = """
    import rospy, sys
    from std_msgs.msg import Bool, Int32
    rospy.init_node("arm")
    enabled = []
    rospy.Subscriber("enable", Bool, enabled.append)
    pose = rospy.Publisher("pose", Int32, queue_size=1)
    for number in range(10):
        pose.publish(number)
        rospy.sleep(0.02)
    if not enabled:
        sys.exit("never enabled")
"""
EYE = """
    import rospy
    from std_msgs.msg import Int32
    rospy.init_node("eye")
    rospy.Subscriber("pose", Int32, lambda message: None)
    rospy.spin()
"""


@pytest.fixture
def plan(tmp_path: Path) -> RunPlan:
    (tmp_path / "startup.scr").write_text(SCRIPT + "!\n", encoding="utf-8")
    for app, source in (("base", BASE), ("arm", ARM), ("eye", EYE)):
        (tmp_path / f"{app}.py").write_text(dedent(source), encoding="utf-8")
    return RunPlan((str(tmp_path),), seconds=1.0, tasks="greenlet")


def explored(plan: RunPlan, policy: str, seeds: int, connect_s: float | None = 0.2) -> Report:
    return Expedition(plan, seeds=seeds, policy=policy, jobs=1, connect_s=connect_s, until_failure=True).run()


@pytest.mark.slow
def test_message_lost_by_a_late_connection_is_found_and_shrunk(plan: RunPlan) -> None:
    report = explored(plan, "random", 10)
    (told,) = report.findings
    assert "ARM" in told.finding.failure.title
    assert told.shrunk is not None
    (move,) = told.shrunk.moves
    assert (move.task, move.chosen, move.question) == (
        "connection of /base to /arm on /enable",
        "100ms",
        "slow connection",
    )
    assert any("/enable connects in 100ms" in line for line in told.timeline)
    schedule = told.shrunk.verdict.schedule
    assert str(schedule).endswith(":connect=200ms")
    assert report.to_dict()["failures"][0]["shrunk"]["moves"][0]["question"] == "slow connection"


@pytest.mark.slow
def test_a_failure_replays_to_its_digest(plan: RunPlan) -> None:
    report = explored(plan, "random", 10)
    (told,) = report.findings
    found = report.schedule_of(told)
    first, again = (report.trial.run(Schedule.parse(found.text())) for _ in range(2))
    assert first.failed
    assert first.trace == again.trace
    deviations = found.at(dict(first.deviations))
    assert report.trial.run(deviations).trace == first.trace


@pytest.mark.slow
@pytest.mark.parametrize(
    ("policy", "seeds"),
    [("pct", 10), ("dfs", 60), ("all", 10)],
)
def test_every_policy_draws_delays(plan: RunPlan, policy: str, seeds: int) -> None:
    assert [told.finding.failure.kind for told in explored(plan, policy, seeds).findings] == ["ended with an error"]


@pytest.mark.slow
def test_connections_keep_the_delays_of_the_mission_by_default(plan: RunPlan) -> None:
    assert explored(plan, "random", 2, connect_s=None).findings == []


@pytest.mark.slow
def test_the_usual_delays_give_the_usual_run(plan: RunPlan) -> None:
    trial = explored(plan, "random", 1, connect_s=None).trial
    usual = [
        trial.run(Schedule.parse(text)).trace for text in ("fifo", "at:connect=200ms", "random:3:connect=1s:from=5s")
    ]
    assert len(set(usual)) == 1
