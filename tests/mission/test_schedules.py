"""Whole missions under schedules: the same schedule gives the same trace, also on the other context, and nothing
leaks."""

from __future__ import annotations

import gc
import multiprocessing
import resource
import threading
from pathlib import Path

import pytest

from cfepy.mission import Mission, read_mission
from cfepy.rtos import NotingPolicy, Policy
from cfepy.schedules import Schedule
from cfepy.writing.console import Console
from tests.mission.flights import write_mission

pytest.importorskip("greenlet")
LOCKED = """
    import threading
    import rospy

    rospy.init_node("locked", anonymous=True)
    first, second = threading.{kind}(), threading.{kind}()

    def work(one, other):
        with one:
            rospy.get_time()
            with other:
                pass

    threading.Thread(target=work, args=(first, second)).start()
    threading.Thread(target=work, args=(second, first)).start()
    with threading.Condition() as condition:
        condition.wait()
"""


def fly(
    mission: str, schedule: Schedule | None, tasks: str = "greenlet", seconds: float = 0.65
) -> tuple[str, NotingPolicy]:
    """Return digest and decisions of one flight. Without a schedule, it uses the plain kernel."""
    recorded = NotingPolicy(None if schedule is None else schedule.policy())
    policy = None if schedule is None else recorded
    with Mission(mission, console=Console(quiet=True), tasks=tasks, policy=policy) as flight:
        flight.run_for(seconds)
        return flight.trace.digest(), recorded


@pytest.mark.parametrize("mission", ["capture", "sched", "rx64m_pubsub"])
def test_exploring_without_a_deviation_gives_the_default_run(mission: str) -> None:
    assert fly(mission, Schedule("at"))[0] == fly(mission, None)[0]


@pytest.mark.parametrize("mission", ["capture", "rx64m_pubsub"])
@pytest.mark.parametrize("text", ["random:1", "pct:2:3", "random:3:any", "random:4:hold=500us", "pct:5:2:any:hold=1ms"])
def test_schedule_is_reproduced_on_the_other_context(mission: str, text: str) -> None:
    schedule = Schedule.parse(text)
    digest, recorded = fly(mission, schedule)
    again, replayed = fly(mission, schedule.at(recorded.deviations), "thread")
    assert again == digest
    assert replayed.choices == recorded.choices
    assert recorded.moments


@pytest.mark.parametrize("kind", ["Lock", "RLock"])
def test_locks_taken_in_opposite_order_are_a_deadlock(tmp_path: Path, kind: str) -> None:
    startup = "CFE_APP, locked.py, __main__, LOCKED, 100, 65536, 0x0, 0;\n!\n"
    mission = write_mission(tmp_path, startup, locked=LOCKED.replace("{kind}", kind))

    def circles(policy: Policy) -> list[list[str]]:
        with Mission(mission, console=Console(quiet=True), tasks="greenlet", policy=policy) as flight:
            flight.run_for(0.65)
            return [[str(wait) for wait in circle] for circle in flight.kernel.deadlocked()]

    assert circles(Policy()) == []
    found = next(each for seed in range(50) if (each := circles(Schedule("random", seed).policy() or Policy())))
    assert len(found) == 1
    assert len(found[0]) == 2
    assert all(" waits for lock " in wait and ", held by " in wait for wait in found[0])


def flown_again_and_again(tasks: str, seconds: float, count: int) -> list[tuple[int, int, int]]:
    """Objects, threads and the highest memory in KiB of this process, five times on the way."""
    spec = read_mission("capture")
    seen: list[tuple[int, int, int]] = []
    for seed in range(count + 1):
        policy = Schedule("random", seed, any_priority=True).policy()
        with Mission(spec, console=Console(quiet=True), tasks=tasks, policy=policy) as flight:
            flight.run_for(seconds)
        del flight
        if seed % 10 == 0:
            gc.collect()
        if seed % (count // 5) == 0:
            memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
            seen.append((len(gc.get_objects()), threading.active_count(), memory))
    return seen[1:]


@pytest.mark.slow
@pytest.mark.parametrize(
    ("tasks", "seconds", "count"), [("thread", 0.2, 2_000), ("greenlet", 0.2, 2_000), ("greenlet", 0.65, 500)]
)
def test_thousands_of_schedules_leave_nothing_in_the_process(tasks: str, seconds: float, count: int) -> None:
    """Most flights end before the nodes start, so that most of the time goes into boot and end. Fewer include nodes.

    The latter are on greenlets: the C library keeps memory for each thread, and takes a thousand flights to have
    enough. The process is a new one, because the remains of other tests would be measured, too.
    """
    with multiprocessing.get_context("spawn").Pool(1) as pool:
        seen = pool.apply(flown_again_and_again, (tasks, seconds, count))
    objects, threads, memory = zip(*seen, strict=True)
    assert max(objects) - min(objects) < 200
    assert len(set(threads)) == 1
    assert memory[-1] - memory[0] < 8_192
