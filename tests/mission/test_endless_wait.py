"""Waits that no task can end are reported; waits that a message, a time or a thread may end are not."""

from __future__ import annotations

from pathlib import Path

import pytest

from cfepy.attachment import Attachment
from cfepy.mission import EndlessWaits, Mission, endless_waits
from cfepy.pilot import RunPlan, fly
from cfepy.schedules import Schedule
from rospy_shim.types.msgs import message_class
from tests.extra.exploration import missions

HEAD = """
    import queue
    import threading
    import rospy
    from std_msgs.msg import Int32

    rospy.init_node("pair")
"""
SENTINEL = """
    things = queue.Queue()


    def work():
        while things.get() is not None:
            pass


    threads = [threading.Thread(target=work) for _ in range(2)]
    for each in threads:
        each.start()
    things.put(None)
    for each in threads:
        each.join()
"""
TOO_LATE = """
    told = threading.Condition()


    def tell():
        with told:
            told.notify()


    teller = threading.Thread(target=tell)
    teller.start()
    teller.join()
    with told:
        told.wait()
"""
BY_MESSAGE = """
    class Keeper:
        def __init__(self):
            self.things = queue.Queue()
            rospy.Subscriber("a", Int32, self.take)

        def take(self, message):
            self.things.put(message)

    keeper = Keeper()
    keeper.things.get()
"""
BY_TIMER = """
    told = threading.Event()
    rospy.Timer(rospy.Duration(30), lambda event: told.set(), oneshot=True)
    told.wait()
"""
BY_HOOK = """
    told = threading.Event()
    rospy.on_shutdown(told.set)
    told.wait()
"""
BY_LOOP = """
    told = threading.Event()


    def count():
        number = 0
        while not rospy.is_shutdown():
            number += 1
            if number == 1000:
                told.set()
            rospy.sleep(0.1)


    threading.Thread(target=count).start()
    told.wait()
"""
BY_BLOCK = """
    from contextlib import contextmanager

    told = threading.Event()


    @contextmanager
    def telling():
        yield
        told.set()


    def work():
        with telling():
            rospy.sleep(1000)


    threading.Thread(target=work).start()
    told.wait()
"""
BY_LIST = """
    told = [threading.Event() for _ in range(2)]


    def work(events):
        for each in events:
            rospy.sleep(1000)
            each.set()


    threading.Thread(target=work, args=(told,)).start()
    told[1].wait()
"""
PARKED = """
    rospy.Subscriber("a", Int32, print)
    stop = threading.Event()
    stop.wait()
"""
IDLE = """
    things = queue.Queue()


    def work():
        while True:
            things.get()


    threading.Thread(target=work, daemon=True).start()
    things.put(1)
    rospy.spin()
"""
SERVICE = """
    from std_srvs.srv import Empty, EmptyResponse

    lock = threading.RLock()


    def handle(request):
        with lock:
            return EmptyResponse()


    rospy.Service("a", Empty, handle)
    with lock:
        rospy.ServiceProxy("a", Empty)()
"""
RW_LOCK = """
def RW(cfe):
    lock = cfe.os.rw_lock_create("LOCK")
    cfe.os.rw_lock_read_take(lock)
    cfe.os.rw_lock_write_take(lock)
"""
BEHIND_A_WRITER = """
def RW(cfe):
    lock = cfe.os.rw_lock_create("LOCK")
    cfe.os.rw_lock_read_take(lock)
    cfe.es.create_child_task("WRITER", lambda: cfe.os.rw_lock_write_take(lock), 8192, 50)
    cfe.es.run_loop()
    cfe.os.task_delay(200)
    cfe.os.rw_lock_read_take(lock)
"""
SEMAPHORE = """
def RW(cfe):
    cfe.os.bin_sem_take(cfe.os.bin_sem_create("DONE", 0))
"""
GIVEN_BY_TIMER = """
def RW(cfe):
    done = cfe.os.bin_sem_create("DONE", 0)
    cfe.os.timer_set(cfe.os.timer_create("LATER", lambda timer: cfe.os.bin_sem_give(done)), 60_000_000, 0)
    cfe.os.bin_sem_take(done)
"""
GIVEN_BY_OTHER = """
def RW(cfe):
    cfe.os.bin_sem_take(cfe.os.bin_sem_create("DONE", 0))


def Other(cfe):
    cfe.os.task_delay(100)
    done = cfe.os.bin_sem_get_id_by_name("DONE")
    cfe.sb.receive_buffer(cfe.sb.create_pipe(4, "WORK"))
    cfe.os.bin_sem_give(done)
"""
FULL = """
    import sys
    things, guard = queue.Queue(2), threading.Lock()


    def work():
        while True:
            things.get()
            with guard:
                pass


    def fill():
        with guard:
            for number in range(6):
                things.put(number)


    def other(message):
        things.{call}


    rospy.Subscriber("a", Int32, other)
    threading.Thread(target=work, daemon=True).start()
    filler = threading.Thread(target=fill, daemon=True)
    filler.start()
    {end}
"""
BY_RIGHT = [BY_MESSAGE, BY_TIMER, BY_HOOK, BY_LOOP, BY_BLOCK, BY_LIST, PARKED, IDLE]
NAMES = ["message", "timer", "hook", "loop", "block", "list", "parked", "idle"]


class Look(Attachment):
    """Looks at the end of the time of the run."""

    def __init__(self) -> None:
        self.found = EndlessWaits([], [])
        self._mission: Mission | None = None

    def begin(self, mission: Mission) -> None:
        self._mission = mission

    def conclude(self) -> None:
        assert self._mission is not None
        self.found = endless_waits(self._mission)


def found_in(folder: Path, tasks: str = "greenlet") -> EndlessWaits:
    look = Look()
    flown = fly(RunPlan((str(folder),), seconds=1.0, tasks=tasks), attachments=[look])
    assert flown.results.endless_waits == [each.text for each in look.found.alone]
    return look.found


def in_node(folder: Path, source: str, tasks: str = "greenlet") -> EndlessWaits:
    return found_in(missions.write(folder, {"PAIR": HEAD + source}), tasks)


def in_app(folder: Path, source: str) -> EndlessWaits:
    (folder / "rw.py").write_text(source, encoding="utf-8")
    entries = [("RW", "RW"), *([("Other", "OTHER")] if "Other" in source else [])]
    lines = [f"CFE_APP, rw, {entry}, {name}, 50, 8192, 0, 0;\n" for entry, name in entries]
    (folder / "startup.scr").write_text("".join(lines) + "!\n", encoding="utf-8")
    return found_in(folder)


@pytest.mark.parametrize("tasks", ["thread", "greenlet"])
def test_worker_without_a_sentinel_waits_forever_when_it_is_joined(tmp_path: Path, tasks: str) -> None:
    found = in_node(tmp_path, SENTINEL, tasks)
    (wait,) = found.alone
    assert (wait.app, wait.task, wait.place, found.circles) == ("PAIR", "PAIR.pair.2.2", "pair.py:12", [])
    assert wait.text == (
        "PAIR.pair.2.2 waits forever for the end of Queue.get() at pair.py:12, "
        f"since {wait.since_ns / 1e9:.6f} s; no remaining task can end this wait"
    )


def test_full_queue_is_endless_when_its_reader_needs_the_lock_of_its_writer(tmp_path: Path) -> None:
    (wait,) = in_node(tmp_path, FULL.format(call="put(message)", end="filler.join()")).alone
    assert (wait.task, wait.what, wait.place) == ("PAIR.pair.2.3", "the end of Queue.put()", "pair.py:22")


def test_endless_wait_is_found_whatever_another_node_added_to_a_message_class(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """All nodes of a process share the classes, and actionlib adds a method to one of them."""

    def named(kind: type, name: str) -> object:
        return getattr(kind, name)

    monkeypatch.setattr(message_class("actionlib_msgs/GoalStatus"), "named", classmethod(named), raising=False)
    (wait,) = in_node(tmp_path, FULL.format(call="put(message)", end="filler.join()")).alone
    assert wait.task == "PAIR.pair.2.3"


def test_full_queue_that_a_callback_may_empty_is_not_reported(tmp_path: Path) -> None:
    assert in_node(tmp_path, FULL.format(call="get()", end="filler.join()")) == ([], [])


@pytest.mark.parametrize(("sleep_s", "count"), [(0.3, 1), (0.05, 0)])
def test_program_that_ends_with_an_error_leaves_its_long_endless_waits(
    tmp_path: Path, sleep_s: float, count: int
) -> None:
    end = f"rospy.sleep({sleep_s})\n    sys.exit('not done')"
    folder = missions.write(tmp_path, {"PAIR": HEAD + FULL.format(call="put(message)", end=end)})
    plan = RunPlan((str(folder),), seconds=1.5, tasks="greenlet", schedule=Schedule.parse("at"))
    flown = fly(plan)  # a lock has a known holder only under a schedule
    ended, *stuck = flown.results.problems
    assert ended == "PAIR ended with exit status 1 (node /pair): not done"
    assert [text.partition(",")[0] for text in stuck] == [
        "PAIR.pair.2.3 waits forever for the end of Queue.put() at pair.py:22"
    ] * count


def test_wait_after_the_last_notify_is_endless(tmp_path: Path) -> None:
    (wait,) = in_node(tmp_path, TOO_LATE).alone
    assert (wait.task, wait.what, wait.place) == ("PAIR", "the end of Condition.wait()", "pair.py:20")


@pytest.mark.parametrize("source", BY_RIGHT, ids=NAMES)
def test_wait_that_another_task_may_end_is_not_reported(source: str, tmp_path: Path) -> None:
    assert in_node(tmp_path, source) == ([], [])


def test_service_that_needs_a_lock_of_its_caller_is_a_deadlock(tmp_path: Path) -> None:
    (circle,) = in_node(tmp_path, SERVICE).circles
    assert [(wait.task, wait.what, wait.holder) for wait in circle] == [
        ("PAIR", "an answer of service /a", "PAIR.a.3"),
        ("PAIR.a.3", "lock 5 of PAIR", "PAIR"),
    ]


def test_reader_that_wants_to_write_waits_forever(tmp_path: Path) -> None:
    ((wait,),) = in_app(tmp_path, RW_LOCK).circles
    assert (wait.task, wait.what, wait.place, wait.holder) == ("RW", "writers of lock LOCK", "rw.py:5", "RW")


def test_reader_that_reads_again_behind_a_writer_is_a_deadlock(tmp_path: Path) -> None:
    (circle,) = in_app(tmp_path, BEHIND_A_WRITER).circles
    assert [(wait.task, wait.holder) for wait in circle] == [("RW", "WRITER"), ("WRITER", "RW")]


def test_wait_for_a_semaphore_without_a_giver_is_endless(tmp_path: Path) -> None:
    (wait,) = in_app(tmp_path, SEMAPHORE).alone
    assert (wait.task, wait.what, wait.place) == ("RW", "semaphore DONE", "rw.py:3")


@pytest.mark.parametrize("source", [GIVEN_BY_TIMER, GIVEN_BY_OTHER], ids=["timer", "other"])
def test_wait_for_a_semaphore_with_a_giver_is_not_reported(source: str, tmp_path: Path) -> None:
    assert in_app(tmp_path, source) == ([], [])
