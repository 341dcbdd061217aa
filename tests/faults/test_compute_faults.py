"""The fault `compute`: work that takes longer, and the tasks that it delays."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.faults import FaultPlan
from cfepy.faults.plan_check import check_plan
from cfepy.mission import read_mission
from cfepy.status import UsageError
from tests.faults.worlds import SOURCE, TAKER, fly, row, told, values
from tests.mission.flights import write_mission

WORKER = """
    def taker_main(cfe):
        cfe.es.run_loop()
        while cfe.es.run_loop():
            cfe.os.task_delay(100)
            before = cfe.psp.get_time()
            cfe.psp.compute(1000)
            cfe.os.printf("worked %d us" % ((cfe.psp.get_time() - before) // 10))
"""


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_longer_message_delays_tasks_of_lower_priority(tmp_path: Path, tasks: str) -> None:
    longer = {"compute": "TAKER", "message": "NUMBER_TLM", "number": 4, "for": 0.25}
    mission = fly(tmp_path, longer, tasks=tasks)
    assert mission.record.history["TAKER"].cpu_ns == 250_000_000
    assert row(mission, "compute-1")["details"] == ["lets TAKER compute for 0.25 s"]
    lines = [line.split(" at ")[0] for line in mission.console.lines if " takes " in line]
    late = lines.index("TAKER takes 3")
    assert lines[late - 1] == "OTHER takes 2"  # SOURCE, of higher priority, runs meanwhile; OTHER gets all at once
    assert values(mission, "OTHER") == list(range(len(values(mission, "OTHER"))))


@pytest.mark.slow
def test_wait_takes_longer_from_an_instant_on(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"compute": "TAKER", "after": 1.5, "count": 3, "for": 0.01})
    assert mission.record.history["TAKER"].cpu_ns == 30_000_000
    once = fly(tmp_path, {"compute": "TAKER", "at": [1.5, 2], "for": 0.01, "name": "late"})
    assert row(once, "late")["times"] == 2
    assert all(began >= asked for began, asked in zip(row(once, "late")["at_s"], (1.5, 2), strict=True))


def test_work_takes_longer_by_a_factor(tmp_path: Path) -> None:
    slow = fly(tmp_path, {"compute": ["TAKER", "OTHER"], "times": 4, "after": 1.5}, taker=WORKER)
    worked = told(slow, "worked")
    assert set(worked) == {"worked 1000 us", "worked 4000 us"}
    assert worked == sorted(worked)
    assert row(slow, "compute-1")["details"][0] == "lets TAKER compute for 0.004 s instead of 0.001 s"


def test_compute_fault_is_limited_to_one_task(tmp_path: Path) -> None:
    mission = fly(tmp_path, {"compute": "TAKER", "for": 0.01, "task": "OTHER*"})
    assert row(mission, "compute-1")["never"] == "no matching occasion occurred"


@pytest.mark.parametrize(
    ("fault", "why"),
    [
        ({"compute": "A"}, "compute requires for or times, such as `for: 0.02`"),
        ({"compute": "A", "for": 1, "times": 2}, "cannot be combined with for"),
        ({"compute": "A", "message": "/x", "times": 2}, "cannot be combined with message"),
        ({"compute": "A", "for": 0}, "must be a number of seconds greater than 0"),
    ],
)
def test_invalid_compute_fault_is_refused(fault: dict[str, object], why: str) -> None:
    with pytest.raises(UsageError, match=why):
        FaultPlan.from_dict({"faults": [fault]})


def test_compute_fault_is_written_as_it_was_read() -> None:
    plain = {"compute": "A", "name": "compute-1", "number": 3, "message": "/x", "task": "A", "for": 0.02}
    assert FaultPlan.from_dict({"faults": [plain]}).to_dict() == {"faults": [plain]}


@pytest.mark.slow
def test_unknown_task_is_found_by_the_check(tmp_path: Path) -> None:
    from cfepy.faults.targets import look_at

    startup = (
        "CFE_APP, source, source_main, SOURCE, 50, 16384, 0, 0;\nCFE_APP, taker, taker_main, TAKER, 60, 16384, 0, 0;\n!"
    )
    spec = read_mission(str(write_mission(tmp_path, startup, source=SOURCE, taker=TAKER)))
    plan = FaultPlan.from_dict({"faults": [{"compute": "TAKER", "for": 1, "task": "TAKE"}]})
    assert [error.text for error in check_plan(plan, spec, look_at(spec))] == ["unknown task TAKE; did you mean TAKER?"]


NODES = """
    CFE_APP, talker.py,   __main__, TALKER,   100, 8192, 0, 0;
    CFE_APP, listener.py, __main__, LISTENER, 90,  8192, 0, 0;
    !
"""
TALKER = """
    import rospy
    from std_msgs.msg import Float64
    rospy.init_node("talker")
    times = rospy.Publisher("/times", Float64, queue_size=10)
    rospy.sleep(1)
    for number in range(4):
        times.publish(rospy.get_time())
        rospy.sleep(0.1)
"""
LISTENER = """
    import rospy
    from std_msgs.msg import Float64
    rospy.init_node("listener")
    rospy.Subscriber("/times", Float64, lambda message: print("after", round((rospy.get_time() - message.data) * 1e3)))
    rospy.spin()
"""


@pytest.mark.slow
def test_compute_fault_applies_to_callbacks_of_nodes(tmp_path: Path) -> None:
    third = {"compute": "LISTENER", "message": "/times", "number": 3, "for": 0.02}
    yaml = "nodes: {LISTENER: {compute: {/times: 2 ms}}}"
    twice = {"compute": "LISTENER", "times": 2}
    mission = fly(tmp_path, third, twice, startup=NODES, talker=TALKER, listener=LISTENER, mission_yaml=yaml)
    assert [line.split()[-1] for line in mission.console.lines if "] after " in line] == ["4", "4", "24", "4"]
