"""Faults whose instants the schedule chooses: each of them can occur, and none occurs under fifo."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import pytest
import yaml

from cfepy.extra.exploration import Expedition, Report, Trial
from cfepy.extra.exploration.verdict import INVARIANT
from cfepy.faults import FaultPlan
from cfepy.pilot import RunPlan, fly
from cfepy.rtos import Decision, Policy, Question
from cfepy.schedules import Schedule
from cfepy.status import UsageError
from tests.faults import worlds
from tests.mission.flights import write_mission

STARTUP = """
    CFE_APP, voter.py,      __main__, VOTER,      100, 16384, 0x0, 0;
    CFE_APP, candidates.py, __main__, CANDIDATES, 100, 16384, 0x0, 0;
    !
"""
VOTER = """
    import os
    import rospy
    from std_msgs.msg import String

    VOTED = "/tmp/voted"

    def write(name):
        with open(VOTED, "w") as file:
            file.write(name)

    def on_request(message):
        voted = open(VOTED).read() if os.path.exists(VOTED) else ""
        if voted in ("", message.data):
            PERSIST

    rospy.init_node("voter")
    vote = rospy.Publisher("vote", String, queue_size=10)
    rospy.Subscriber("request", String, on_request)
    rospy.spin()
"""
LATE = "vote.publish(message.data); write(message.data)"
EARLY = "write(message.data); vote.publish(message.data)"
CANDIDATES = """
    import rospy
    from std_msgs.msg import String

    rospy.init_node("candidates")
    request = rospy.Publisher("request", String, queue_size=10)
    rospy.sleep(0.2)
    for name in ("a", "b") * 3:
        request.publish(name)
        rospy.sleep(0.2)
"""
MISSION = """
    invariants:
      one vote: {topic: /vote, holds: "last is None or msg.data == last.data"}
    nodes:
      VOTER: {respawn: true, respawn_delay: 0.1 s}
"""
CRASH = "faults:\n  - {crash: VOTER, explored: 1, after: 0.6}\n"
DROP = "faults:\n  - {drop: /request, explored: 1}\n"


FAULTS = {"crash": CRASH, "drop": DROP, "reset": "faults:\n  - {reset: processor, explored: 1, after: 0.6}\n"}


def plan_of(folder: Path, faults: str, how: str = LATE, tasks: str = "greenlet") -> RunPlan:
    """Return the vote's mission with a fault."""
    write_mission(folder, STARTUP, voter=VOTER.replace("PERSIST", how), candidates=CANDIDATES, mission_yaml=MISSION)
    (folder / "faults.yaml").write_text(faults, encoding="utf-8")
    return RunPlan((str(folder),), seconds=1.9, tasks=tasks, faults=str(folder / "faults.yaml"))


def explored(plan: RunPlan, policy: str = "all", seeds: int = 60, depth: int | None = None) -> Report:
    return Expedition(plan, seeds=seeds, policy=policy, depth=depth, jobs=1, until_failure=True).run()


@pytest.mark.slow
def test_crash_between_two_steps_is_found_and_shrunk(tmp_path: Path) -> None:
    (told,) = explored(plan_of(tmp_path, CRASH)).findings
    assert told.finding.failure.kind == INVARIANT
    assert told.shrunk is not None
    (move,) = told.shrunk.moves
    assert (move.task, move.chosen, move.question) == ("fault crash-1", "strikes", "fault")
    assert any("fault crash-1 strikes" in line for line in told.timeline)


@pytest.mark.slow
@pytest.mark.parametrize(("how", "fails"), [(LATE, True), (EARLY, False)])
def test_every_instant_of_a_crash_is_tried(tmp_path: Path, how: str, fails: bool) -> None:
    report = explored(plan_of(tmp_path, CRASH, how), "dfs", 150, depth=1)
    assert report.tally.failed == fails


@pytest.mark.parametrize("kind", FAULTS)
def test_explored_fault_does_not_strike_under_fifo(tmp_path: Path, kind: str) -> None:
    plan = plan_of(tmp_path, FAULTS[kind])
    flown = fly(plan)
    (row,) = flown.mission.record.rows("faults")
    assert (row["times"], row["explored"]) == (0, True)
    assert row["never"] == "no schedule selected it; cfepy explore tries schedules that do"
    without = fly(replace(plan, faults=None))
    assert flown.trace == without.trace


class Strikes(Policy):
    """Answers the nth question with yes."""

    def __init__(self, number: int) -> None:
        super().__init__()
        self._left = number

    def choose(self, decision: Decision) -> int:
        if decision.question is None:
            return 0
        self._left -= 1
        return int(not self._left)


@pytest.mark.parametrize("number", [1, 4])
def test_explored_drop_can_strike_any_message(tmp_path: Path, number: int) -> None:
    flown = fly(plan_of(tmp_path, DROP), policy=Strikes(number))
    (row,) = flown.mission.record.rows("faults")
    assert row["details"] == [f"drops /request #{number} sent by CANDIDATES"]


@pytest.mark.slow
@pytest.mark.parametrize("kind", FAULTS)
def test_threads_and_greenlets_give_the_same_verdicts(tmp_path: Path, kind: str) -> None:
    plan = plan_of(tmp_path, FAULTS[kind])
    one, other = (
        [Trial(replace(plan, tasks=tasks)).run(Schedule("random", seed)) for seed in range(6)]
        for tasks in ("thread", "greenlet")
    )
    assert one == other
    assert len({verdict.trace for verdict in one}) > 2


def test_early_and_late_occasions_have_equal_chances() -> None:
    drawn = []
    for seed in range(300):
        policy = Schedule("random", seed).policy()
        assert policy is not None
        question = Question("fault drop-1", "fault", ("no", "yes"), "{}", is_rare=True)
        answers = (policy.choose(Decision(at, 0, (), False, False, None, question)) for at in range(2000))
        drawn.append(next(at for at, answer in enumerate(answers) if answer))
    assert min(drawn) == 0
    assert max(drawn) < 1024
    for least, most in ((0, 4), (4, 32), (32, 200), (200, 1024)):
        assert sum(least <= at < most for at in drawn) > 30


@pytest.mark.parametrize(
    ("fault", "text"),
    [
        ("{drop: /a, explored: 1, at: 2}", "cannot be combined with"),
        ("{drop: /a, explored: 1, probability: 0.5}", "cannot be combined with explored"),
        ("{drop: /a, explored: 1, count: 2}", "cannot be combined with explored"),
        ("{reset: processor, explored: 0}", "must be a whole number of at least 1, not 0"),
        ("{fill: PIPE, explored: 1}", "unknown option of fill"),
    ],
)
def test_invalid_explored_fault_is_refused(fault: str, text: str) -> None:
    with pytest.raises(UsageError, match=text):
        FaultPlan.from_dict(yaml.safe_load(f"faults: [{fault}]"))


def test_call_that_may_fail_is_a_scheduling_point(tmp_path: Path) -> None:
    mission = str(write_mission(tmp_path, worlds.STARTUP, source=worlds.SOURCE, taker=worlds.TAKER, other=worlds.TAKER))
    never = tmp_path / "never.yaml"
    never.write_text(
        "faults: [{fail: OS_TaskDelay, after: 1000}, {fail: CFE_SB_ReceiveBuffer, after: 1000}]\n", encoding="utf-8"
    )
    schedule = Schedule.parse("random:1:any")
    plain, faulty = (Trial(RunPlan((mission,), seconds=2, faults=f)).run(schedule) for f in (None, str(never)))
    assert faulty.decisions == plain.decisions > 0
