"""Stopping, stepping and inspecting; and that this does not change the run."""

from __future__ import annotations

import io
from pathlib import Path
from typing import Any

import pytest

from cfepy.extra.debugger.debugger import Debugger
from cfepy.pilot.pilot import Flown, fly
from cfepy.pilot.plan import RunPlan
from cfepy.schedules.schedule import Schedule

COUNTER = """
import rospy
from std_msgs.msg import Int32

def on_number(message):
    total = message.data + 1
    rospy.loginfo("got %d", total)

rospy.init_node("counter")
publisher = rospy.Publisher("/numbers", Int32, queue_size=10)
rospy.Subscriber("/numbers", Int32, on_number)
for number in range(3):
    rospy.sleep(0.1)
    publisher.publish(number)
rospy.sleep(0.1)
print(missing)
"""
BOTH = pytest.mark.parametrize("tasks", ["thread", "greenlet"])


@pytest.fixture
def plan(tmp_path: Path) -> RunPlan:
    """A run of a node that counts, and dies."""
    script = tmp_path / "counter.py"
    script.write_text(COUNTER, encoding="utf-8")
    return RunPlan((str(script),), command="node", seconds=3)


def debugged(plan: RunPlan, commands: str = "", **options: Any) -> tuple[str, Flown]:
    """Run with a debugger whose user has prepared the commands. Returns its output."""
    spec, stream = plan.spec(), io.StringIO()
    debugger = Debugger(spec, commands=io.StringIO(commands), stream=stream, **options)
    flown = fly(plan, attachments=[debugger], spec=spec)
    return stream.getvalue(), flown


@BOTH
def test_debugger_does_not_change_the_run(plan: RunPlan, tasks: str) -> None:
    plain = fly(plan).trace
    plan = RunPlan(plan.words, command="node", seconds=3, tasks=tasks)
    for options in ({"stops": ["/numbers"]}, {"step": True}, {"from_ns": 700_000_000, "step": True}):
        said, flown = debugged(plan, **options)
        assert flown.trace == plain
        assert said


def test_stop_shows_the_current_line_of_the_application(plan: RunPlan) -> None:
    said, _ = debugged(plan, "c\nc\nc\n", stops=["/numbers"])
    lines = said.splitlines()
    assert lines[0].startswith("0.")
    assert lines[0].endswith("COUNTER: /numbers of /counter: data: 0")
    assert lines[1].endswith("in <module>: publisher.publish(number)")
    assert len(lines) == 6


def test_step_continues_to_the_next_event(plan: RunPlan) -> None:
    said, _ = debugged(plan, "s\n\nstep\nc\nc\nc\n", stops=["msg.data == 0"])
    steps = [line.split(maxsplit=1)[1] for line in said.splitlines() if line[0].isdigit()]
    assert steps[1] == "COUNTER/COUNTER.numbers.1: goes on"
    assert steps[2].startswith("COUNTER/COUNTER.numbers.1: takes /numbers out of pipe COUNTER.numbers")
    assert steps[3].startswith("COUNTER/COUNTER.numbers.1: console: [counter] [INFO]")
    assert len(steps) == 4


def test_tasks_pipes_where_and_help(plan: RunPlan) -> None:
    said, _ = debugged(plan, "tasks\npipes\nw\nwhat\nc\n", stops=["msg.data == 1"])
    assert "CFE_TBL (task" in said
    assert "TBL_CMD_PIPE" in said
    assert said.count("publisher.publish(number)") == 2
    assert "continue to the next breakpoint" in said


def test_quit_ends_the_run(plan: RunPlan) -> None:
    ended: list[bool] = []
    said, _ = debugged(plan, "q\n", stops=["/numbers"], on_quit=lambda: ended.append(True))
    assert ended == [True]
    assert said.count("/numbers of /counter") == 1


def test_pdb_from_the_first_line(plan: RunPlan) -> None:
    said, _ = debugged(plan, "n\nn\np __name__\nc\nc\n", app="COUNTER")
    assert "import rospy" in said
    assert "'__main__'" in said


def test_pdb_at_a_stop_of_another_task_waits_for_the_application(plan: RunPlan) -> None:
    said, _ = debugged(plan, "w\np message.data\nn\nn\np total\nc\nc\n", app="COUNTER", stops=["msg.data == 2"])
    assert "(Pdb)" in said
    assert "print(missing)" in said  # and where it died
    assert "NameError: name 'missing' is not defined" in said


def test_pdb_opens_where_an_exception_ends_a_node(plan: RunPlan) -> None:
    said, _ = debugged(plan, "p number\nq\n", app="COUNTER", stops=["topic == '/nothing'"])
    assert "NameError: name 'missing' is not defined" in said
    assert said.rstrip().endswith("(Pdb) 2\n(Pdb)")


def test_pdb_opens_where_an_exception_ends_a_cfe_app(tmp_path: Path) -> None:
    (tmp_path / "faulty.py").write_text("def main(cfe):\n    height = 0\n    return 1 / height\n", encoding="utf-8")
    (tmp_path / "startup.scr").write_text("CFE_APP, faulty, main, FAULTY, 50, 16384, 0x0, 0;\n!\n", encoding="utf-8")
    plan = RunPlan((str(tmp_path),), seconds=1, schedule=Schedule.parse("random:1"))
    said, _ = debugged(plan, "p height\nq\n", app="FAULTY", stops=["0x1FFF"])
    assert "FAULTY: ZeroDivisionError: division by zero" in said
    assert "-> return 1 / height" in said
    assert said.count("(Pdb) 0\n") == 1
