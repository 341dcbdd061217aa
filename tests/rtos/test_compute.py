"""A task that computes: due events happen in time meanwhile, and the work takes its full time."""

from __future__ import annotations

import pytest

from cfepy.rtos import Kernel
from cfepy.schedules import make_kernel
from cfepy.schedules.schedule import Schedule

MS = 1_000_000


class World:
    """Tasks that record their actions with times."""

    def __init__(self, kernel: Kernel) -> None:
        self.kernel = kernel
        self.noted: list[tuple[str, int]] = []

    def note(self, what: str) -> None:
        """It happens now."""
        self.noted.append((what, self.kernel.now))

    def worker(self, name: str, work_ns: int, priority: int, delay_ns: int = 0) -> None:
        """A task that computes once."""

        def live() -> None:
            if delay_ns:
                self.kernel.delay(delay_ns)
            self.note(f"{name} begins")
            self.kernel.compute(work_ns)
            self.note(f"{name} ends")

        self.kernel.spawn(name, live, priority)


@pytest.fixture
def world(kernel: Kernel) -> World:
    """Return a world in which no task computes yet."""
    return World(kernel)


def test_computation_takes_its_time(world: World) -> None:
    world.worker("a", 10 * MS, 50)
    world.kernel.run(20 * MS)
    assert world.noted == [("a begins", 0), ("a ends", 10 * MS)]
    assert world.kernel.now == 20 * MS


def test_urgent_task_interrupts_a_computation(world: World) -> None:
    world.worker("slow", 10 * MS, 50)
    world.worker("urgent", 2 * MS, 10, delay_ns=3 * MS)
    world.kernel.run(20 * MS)
    assert world.noted == [
        ("slow begins", 0),
        ("urgent begins", 3 * MS),
        ("urgent ends", 5 * MS),
        ("slow ends", 12 * MS),
    ]


def test_less_urgent_task_waits_for_the_computation(world: World) -> None:
    world.worker("later", 1 * MS, 90, delay_ns=3 * MS)
    world.worker("slow", 10 * MS, 50, delay_ns=1)
    world.kernel.run(20 * MS)
    assert world.noted[1:] == [
        ("slow ends", 10 * MS + 1),
        ("later begins", 10 * MS + 1),
        ("later ends", 11 * MS + 1),
    ]


def test_tasks_of_equal_priority_take_turns(world: World) -> None:
    for name in ("a", "b"):
        world.worker(name, 5 * MS, 50)
    world.kernel.run(20 * MS)
    times = dict(world.noted)
    assert times["a ends"] == pytest.approx(10 * MS, abs=20_000)
    assert times["b ends"] == 10 * MS


def test_computation_is_the_same_in_a_run_in_pieces(world: World) -> None:
    world.worker("a", 10 * MS, 50)
    for end in range(1, 21):
        world.kernel.run(end * MS)
    assert world.noted == [("a begins", 0), ("a ends", 10 * MS)]
    assert world.kernel.tasks == []


def test_task_killed_while_it_computes_ends_at_once(world: World) -> None:
    world.worker("a", 10 * MS, 50)

    def killer() -> None:
        world.kernel.delay(4 * MS)
        world.kernel.kill(world.kernel.tasks[0])

    world.kernel.spawn("killer", killer, 10)
    world.kernel.run(20 * MS)
    assert world.noted == [("a begins", 0)]
    assert world.kernel.tasks == []


def test_computation_of_0_ns_takes_no_time(world: World) -> None:
    world.worker("a", 0, 50)
    world.kernel.run(1)
    assert world.noted == [("a begins", 0), ("a ends", 0)]


@pytest.mark.parametrize("time_ns", [-1, 1.5])
def test_invalid_time_is_refused(world: World, time_ns: float) -> None:
    errors: list[Exception] = []

    def live() -> None:
        try:
            world.kernel.compute(time_ns)  # type: ignore[arg-type]
        except (TypeError, ValueError) as error:
            errors.append(error)

    world.kernel.spawn("a", live, 50)
    world.kernel.run(1)
    assert len(errors) == 1


@pytest.mark.parametrize("schedule", ["random:1", "pct:3:2", "random:5:hold=1ms"])
def test_computation_takes_its_time_under_any_schedule(schedule: str) -> None:
    with make_kernel(policy=Schedule.parse(schedule).policy()) as kernel:
        world = World(kernel)
        world.worker("a", 10 * MS, 50)
        world.worker("b", 5 * MS, 50)
        world.kernel.run(50 * MS)
        assert max(time_ns for _, time_ns in world.noted) >= 15 * MS
        assert {task.cpu_ns for task in kernel.tasks} == set()
