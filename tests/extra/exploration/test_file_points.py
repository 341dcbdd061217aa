"""File calls are scheduling points, and races on files are found and told by the name of the file."""

from __future__ import annotations

from pathlib import Path
from textwrap import dedent

import pytest

from cfepy.extra.exploration import Expedition, Report, Trial
from cfepy.pilot import RunPlan
from cfepy.schedules import Schedule

NAME = "calibration.json"
READ_CHANGE_REPLACE = """
    import json
    import os
    import sys
    import rospy
    from std_msgs.msg import Int32

    PATH = "FOLDER/calibration.json"
    me = os.path.basename(sys.argv[0])[:-3]
    rospy.init_node(me)


    def on_go(message):
        values = json.load(open(PATH)) if os.path.exists(PATH) else {}
        values[me] = message.data
        with open(PATH + "." + me, "w") as file:
            json.dump(values, file)
        os.replace(PATH + "." + me, PATH)


    rospy.Subscriber("go", Int32, on_go, queue_size=5)
    rospy.spin()
"""
READ_LATER = """
    import json
    import sys
    import rospy
    from std_msgs.msg import Int32

    rospy.init_node("judge")
    go = rospy.Publisher("go", Int32, queue_size=5)
    rospy.sleep(0.1)
    go.publish(5)
    rospy.sleep(0.1)
    values = json.load(open("FOLDER/calibration.json"))
    if len(values) != 2:
        sys.exit(f"calibrated: {sorted(values)}")
"""
WRITTEN_IN_PARTS = """
    import sys
    import threading
    import time

    PATH = "FOLDER/mode"
    open(PATH, "w").write("safe")


    def change():
        time.sleep(0.01)
        with open(PATH, "w") as file:
            file.write("science")


    thread = threading.Thread(target=change)
    thread.start()
    time.sleep(0.01)
    text = open(PATH).read()
    if not text:
        sys.exit("the file is empty")
    thread.join()
"""
DATABASE = """
    import sqlite3
    import sys
    import threading
    import time

    PATH = "FOLDER/counts.db"
    with sqlite3.connect(PATH) as made:
        made.execute("CREATE TABLE counts (n INTEGER)")
        made.execute("INSERT INTO counts VALUES (0)")


    def count():
        time.sleep(0.01)
        own = sqlite3.connect(PATH)
        (n,) = own.execute("SELECT n FROM counts").fetchone()
        own.execute("UPDATE counts SET n = ?", (n + 1,))
        own.commit()
        own.close()


    threads = [threading.Thread(target=count) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    (n,) = sqlite3.connect(PATH).execute("SELECT n FROM counts").fetchone()
    if n != 2:
        sys.exit(f"counted {n}")
"""
DESCRIPTORS = """
    import os
    import sys
    import threading
    import time

    PATH = "FOLDER/lock"
    taken = []


    def take():
        time.sleep(0.01)
        if not os.path.exists(PATH):
            os.close(os.open(PATH, os.O_CREAT | os.O_WRONLY))
            taken.append(1)


    threads = [threading.Thread(target=take) for _ in range(2)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    if len(taken) != 1:
        sys.exit("both have the lock")
"""


def plan_of(folder: Path, **nodes: str) -> RunPlan:
    """Return the plan of a mission whose nodes have these sources."""
    lines = [f"CFE_APP, {name}.py, __main__, {name.upper()}, 100, 16384, 0x0, 1;\n" for name in nodes]
    for name, source in nodes.items():
        (folder / f"{name}.py").write_text(dedent(source).replace("FOLDER", str(folder)), encoding="utf-8")
    (folder / "startup.scr").write_text("".join(lines) + "!\n", encoding="utf-8")
    return RunPlan((str(folder),), seconds=1.0)


def explored(plan: RunPlan, seeds: int = 40) -> Report:
    """Return the report of schedules of the policy random."""
    return Expedition(plan, seeds=seeds, policy="random", jobs=1).run()


def test_update_of_a_file_is_lost_between_its_read_and_its_replacement(tmp_path: Path) -> None:
    plan = plan_of(tmp_path, left=READ_CHANGE_REPLACE, right=READ_CHANGE_REPLACE, judge=READ_LATER)
    (told,) = explored(plan, 10).findings
    assert " ".join(map(str.strip, told.timeline[:4])).startswith(
        f"cause: an update of file {tmp_path / NAME} is lost: "
    )
    assert any("writes file " in line for line in told.timeline)


@pytest.mark.parametrize(
    ("source", "said"),
    [(WRITTEN_IN_PARTS, "the file is empty"), (DATABASE, "counted 1"), (DESCRIPTORS, "both have the lock")],
)
@pytest.mark.slow
def test_other_tasks_run_between_two_calls_on_a_file(tmp_path: Path, source: str, said: str) -> None:
    assert [said] == [
        told.finding.failure.text.partition(": ")[2] for told in explored(plan_of(tmp_path, node=source)).findings
    ]


def test_file_points_do_not_change_the_default_run(tmp_path: Path) -> None:
    trial = Trial(plan_of(tmp_path, left=READ_CHANGE_REPLACE, right=READ_CHANGE_REPLACE, judge=READ_LATER))
    plain, asked = trial.run(Schedule()), trial.run(Schedule("at"))
    assert (plain.failures, plain.trace) == (asked.failures, asked.trace)
    assert not plain.failures


def test_schedule_with_file_points_has_one_trace_on_threads_and_greenlets(tmp_path: Path) -> None:
    pytest.importorskip("greenlet")
    plan = plan_of(tmp_path, node=DATABASE)
    one, other = (
        Trial(RunPlan(plan.words, seconds=1.0, tasks=tasks)).run(Schedule.parse("random:3"))
        for tasks in ("thread", "greenlet")
    )
    assert one.trace == other.trace
    assert one.decisions == other.decisions > 0


@pytest.mark.slow
def test_files_that_two_tasks_used_are_listed_without_a_failure(tmp_path: Path) -> None:
    patient = READ_CHANGE_REPLACE.replace("def on_go(message):\n", "def on_go(message):\n        rospy.sleep(DELAY)\n")
    left, right = (patient.replace("DELAY", delay) for delay in ("0.01", "0.03"))
    report = explored(plan_of(tmp_path, left=left, right=right, judge=READ_LATER), 3)
    assert report.findings == []
    (line,) = (line for line in report.breadth.files if line.startswith(f"{tmp_path / NAME}:"))
    assert line.startswith(f"{tmp_path / NAME}: LEFT.go.1 and RIGHT.go.")
    assert line.endswith("changed, JUDGE read it")
