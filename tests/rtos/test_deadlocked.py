"""Deadlocks: circles of waiting tasks."""

from __future__ import annotations

import pytest

from cfepy.rtos import Kernel, Task, WaitList


class World:
    """Tasks that wait for objects that others hold."""

    def __init__(self, kernel: Kernel) -> None:
        self.kernel = kernel
        self.tasks: dict[str, Task] = {}

    def add(self, name: str, holder: str, timeout_ns: int = -1) -> None:
        """Add a task that waits for an object of another task, by name; "" means that no task holds it."""
        waits = WaitList(f"lock of {holder}")
        waits.holders = lambda: [self.tasks[name] for name in holder.split() if name in self.tasks]
        self.tasks[name] = self.kernel.spawn(name, lambda: self.kernel.wait_on(waits, timeout_ns))

    def found(self) -> list[list[str]]:
        """Return the kernel's report after some time."""
        self.kernel.run(1000)
        return [[str(wait) for wait in circle] for circle in self.kernel.deadlocked()]


@pytest.fixture
def world(kernel: Kernel) -> World:
    """Return a world in which no task waits yet."""
    return World(kernel)


def test_circle_is_reported_once_without_waiters_outside_it(world: World) -> None:
    for name, holder in (("outside", "b"), ("a", "b"), ("b", "c"), ("c", "a"), ("d", "e"), ("e", "")):
        world.add(name, holder)
    assert world.found() == [
        [
            "b waits for lock of c, held by c",
            "c waits for lock of a, held by a",
            "a waits for lock of b, held by b",
        ]
    ]


def test_wait_with_a_time_limit_is_not_a_deadlock(world: World) -> None:
    world.add("a", "b")
    world.add("b", "a", 1_000_000)
    assert world.found() == []


def test_task_that_waits_for_itself_is_a_deadlock(world: World) -> None:
    world.add("a", "a")
    assert world.found() == [["a waits for lock of a, held by a"]]


def test_task_that_waits_for_an_ended_holder_is_a_deadlock(world: World) -> None:
    world.tasks["dead"] = world.kernel.spawn("dead", lambda: None)
    world.add("a", "dead")
    assert world.found() == [["a waits for lock of dead, held by dead, which has ended"]]


def test_two_circles_are_both_reported(world: World) -> None:
    for name, holder in (("a", "b"), ("b", "a"), ("c", "d"), ("d", "c")):
        world.add(name, holder)
    assert [len(circle) for circle in world.found()] == [2, 2]


def test_wait_for_several_holders_is_a_deadlock_when_one_of_them_is_blocked(world: World) -> None:
    world.add("a", "b c")
    world.add("b", "", 1_000_000)
    world.add("c", "a")
    assert world.found() == [["a waits for lock of b c, held by c", "c waits for lock of a, held by a"]]
