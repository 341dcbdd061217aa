"""Names of locks and similar objects in a story, and their reported events."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.extra.exploration.operations import AWAITS, CLEARS, HAS, NOTIFIES, RELEASES, SETS, WANTS
from cfepy.extra.exploration.task_look import DOES, WAITS, TaskLook
from cfepy.extra.exploration.trial import Trial
from cfepy.pilot.plan import RunPlan
from cfepy.rtos import Policy
from cfepy.schedules import Schedule
from tests.extra.exploration import missions

LOCKS = """
    import queue
    import threading
    import rospy

    rospy.init_node("locks")
    left, right = threading.Lock(), threading.RLock()
    many = [threading.Lock() for _ in range(2)]
    by_name = {"a": threading.Lock()}
    todo = queue.Queue()


    class Robot:
        def __init__(self):
            self.moved = threading.Event()
            self.changed: threading.Condition = threading.Condition()


    def wait(robot):
        robot.moved.wait()
        with robot.changed:
            robot.changed.wait()


    robots = [Robot(), Robot()]
    threading.Thread(target=wait, args=(robots[1],), name="waiter").start()
    with left, right, right:
        for each in (*many, by_name["a"]):
            with each:
                pass
    robots[1].moved.set()
    robots[0].moved.clear()
    rospy.sleep(0.01)
    with robots[1].changed:
        robots[1].changed.notify()
    todo.get()
"""
OSAL = """
    def Keeper(cfe):
        mutex, full = cfe.os.mut_sem_create("CARD"), cfe.os.bin_sem_create("FULL", 1)
        cfe.os.mut_sem_take(mutex)
        cfe.os.bin_sem_take(full)
        cfe.os.bin_sem_give(full)
        cfe.os.mut_sem_give(mutex)
        cfe.os.bin_sem_give(77)
"""


def looked_at(folder: Path, tasks: str) -> TaskLook:
    """Return an observed run of a mission, which is the same as without observation."""
    trial = Trial(RunPlan((str(folder),), seconds=0.7, tasks=tasks))
    look = TaskLook(trial.plan.spec())
    schedule = Schedule("at")
    told = trial.fly(schedule, [look], look.policy(schedule.policy() or Policy()))
    assert told.verdict.trace == trial.run(schedule).trace
    return look


@pytest.fixture(scope="module")
def look(tmp_path_factory: pytest.TempPathFactory) -> TaskLook:
    return looked_at(missions.write(tmp_path_factory.mktemp("locks"), {"LOCKS": LOCKS}), "thread")


def deeds(look: TaskLook, *verbs: str) -> list[tuple[str, str, str]]:
    return [(deed.verb, deed.thing, deed.place) for deed in look.deeds if deed.verb in verbs]


def test_locks_are_named_by_variable_and_line(look: TaskLook) -> None:
    had = [thing for _, thing, _ in deeds(look, HAS) if "self" not in thing and "todo" not in thing]
    names = ["left (locks.py:6)", "right (locks.py:6)", "many[0] (locks.py:7)", "many[1] (locks.py:7)"]
    assert had == [*names, "by_name['a'] (locks.py:8)"]
    assert "todo (locks.py:9)" in [row.text.removeprefix("waits for ") for row in look.rows if row.kind == WAITS]


def test_objects_of_one_line_are_numbered(look: TaskLook) -> None:
    assert deeds(look, SETS) == [(SETS, "self.moved#2 (locks.py:14)", "locks.py:30")]
    assert deeds(look, CLEARS) == [(CLEARS, "self.moved (locks.py:14)", "locks.py:31")]


def test_waiting_for_holding_and_releasing_a_lock_are_distinguished(look: TaskLook) -> None:
    right = [verb for verb, thing, _ in deeds(look, WANTS, HAS, RELEASES) if thing.startswith("right")]
    assert right == [WANTS, HAS, RELEASES]  # it is taken twice, which no other task sees
    rows = [row.text for row in look.rows if row.kind == DOES and "right" in row.text]
    assert rows == ["has right (locks.py:6)", "releases right (locks.py:6)"]


def test_waits_and_notifications_of_conditions_are_recorded(look: TaskLook) -> None:
    waited = [thing for _, thing, _ in deeds(look, AWAITS)]
    assert waited[:2] == ["self.moved#2 (locks.py:14)", "self.changed#2 (locks.py:15)"]
    (notified,) = (deed for deed in look.deeds if deed.verb == NOTIFIES)
    assert (notified.thing, notified.note) == ("self.changed#2 (locks.py:15)", "1")


def test_objects_of_osal_are_called_by_their_names(tmp_path: Path) -> None:
    missions.write_late(tmp_path)
    with (tmp_path / "apps.py").open("a") as apps:
        apps.write(missions.textwrap.dedent(OSAL))
    (tmp_path / "startup.scr").write_text("CFE_APP, apps, Keeper, KEEPER, 50, 8192, 0, 0;\n!\n", encoding="utf-8")
    rows = [row.text for row in looked_at(tmp_path, "greenlet").rows if row.kind == DOES]
    assert rows[:4] == ["has mutex CARD", "takes semaphore FULL", "gives semaphore FULL", "releases mutex CARD"]
