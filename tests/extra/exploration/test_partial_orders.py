"""The search of orders: every outcome of a small program, in hardly more runs than there are orders."""

from __future__ import annotations

import functools
from collections.abc import Callable
from random import Random
from typing import Any, NamedTuple

import pytest

from cfepy.extra.exploration.partial_orders import Order, OrderSearch
from cfepy.extra.exploration.search import DepthFirst
from cfepy.extra.exploration.steps import GIVES, READS, TAKES, WRITES, StepLog, TaskStep
from cfepy.extra.exploration.verdict import Verdict
from cfepy.rtos import Kernel, Mutex, NotingPolicy, Queue, Semaphore, WaitList
from cfepy.schedules import ExploringKernel, Schedule, make_kernel

Deed = tuple[str, str]
Program = list[list[Deed]]
"""What each task does: a kind of deed, and to which of two things."""
US = 1000


class Flown(NamedTuple):
    """A run: its outcome, its decisions and its steps."""

    outcome: object
    recorded: NotingPolicy
    steps: tuple[TaskStep, ...]


class World:
    """Two variables, mutexes, queues and semaphores, and tasks that do something to them."""

    def __init__(self, kernel: Kernel, program: Program, log: StepLog) -> None:
        assert isinstance(kernel, ExploringKernel)
        self.kernel = kernel
        self.log = log
        log.begin_with(kernel)
        self.values: dict[str, tuple[str, ...]] = {"x": (), "y": ()}
        self.mutexes = {name: Mutex(kernel, name) for name in "xy"}
        self.queues = {name: Queue(kernel, 1, name) for name in "xy"}
        self.semaphores = {name: Semaphore(kernel, 0, None, name) for name in "xy"}
        self.waiting = {name: WaitList(f"condition {name}") for name in "xy"}
        self.images = {"x": 0, "y": 0}
        self.requests = {name: Queue(kernel, 4, f"requests {name}") for name in "xy"}
        self.seen: dict[str, list[object]] = {}
        used = {deed for deeds in program for deed in deeds}
        for which in "xy":
            if {("send", which), ("ask", which)} & used:
                kernel.spawn(f"node {which}", functools.partial(self.serve, which))
        kernel.on_task_error = lambda task, error: True
        for number, deeds in enumerate(program):
            self.start(f"task {number}", deeds)

    def start(self, name: str, deeds: list[Deed]) -> None:
        self.kernel.spawn(name, lambda: self.work(name, deeds))

    def work(self, name: str, deeds: list[Deed]) -> None:
        seen = self.seen.setdefault(name, [])
        for kind, which in deeds:
            self.kernel.charge(0)
            seen.append(getattr(self, kind)(name, which))

    def call(self, thing: str, what: Callable[[], Any], how: str = WRITES) -> Any:
        self.log.begin([(thing, how)])
        result = what()
        self.log.end()
        return result

    def write(self, name: str, which: str) -> None:
        self.log.touch(which)
        self.values[which] = (*self.values[which], name)

    def read(self, name: str, which: str) -> object:
        self.log.touch(which, READS)
        return self.values[which]

    def lock(self, name: str, which: str) -> None:
        self.log.begin([], f"mutex {which}")
        self.mutexes[which].take()
        self.log.end()
        self.log.touch(f"mutex {which}", TAKES)
        self.kernel.charge(0)
        self.write(name, which)
        self.kernel.charge(0)
        self.call(f"mutex {which}", self.mutexes[which].give, GIVES)

    def leave(self, name: str, which: str) -> None:
        """Write under a lock, and write again right after releasing it: no other task can run in between."""
        self.log.begin([], f"mutex {which}")
        self.mutexes[which].take()
        self.log.end()
        self.log.touch(f"mutex {which}", TAKES)
        self.write(name, which)
        self.kernel.charge(0)
        self.call(f"mutex {which}", self.mutexes[which].give, GIVES)
        self.log.part()
        self.write(name, "y" if which == "x" else "x")

    def put(self, name: str, which: str) -> object:
        return self.call(f"queue {which}", lambda: self.queues[which].put(name))

    def get(self, name: str, which: str) -> object:
        return str(self.call(f"queue {which}", lambda: self.queues[which].get(US)))

    def give(self, name: str, which: str) -> None:
        self.call(f"semaphore {which}", self.semaphores[which].give)

    def take(self, name: str, which: str) -> object:
        return self.call(f"semaphore {which}", lambda: self.semaphores[which].take(US))

    def wait(self, name: str, which: str) -> object:
        return str(self.call(f"condition {which}", lambda: self.kernel.wait_on(self.waiting[which], US)))

    def notify(self, name: str, which: str) -> object:
        return self.call(f"condition {which}", lambda: self.kernel.wake_all(self.waiting[which]))

    def serve(self, which: str) -> None:
        """A node: a message changes a variable, a request gets an answer."""
        while True:
            name, reply = self.call(f"requests {which}", lambda: self.requests[which].get())
            self.kernel.charge(0)
            if reply is None:
                self.write(name, which)
            else:
                self.log.touch(which, READS)
                found = self.values[which]
                self.kernel.charge(0)
                self.call(f"reply to {name}", functools.partial(reply.put, found))
            self.kernel.charge(0)

    def send(self, name: str, which: str) -> object:
        return self.call(f"requests {which}", lambda: self.requests[which].put((name, None)))

    def ask(self, name: str, which: str) -> object:
        reply = Queue(self.kernel, 1, f"reply to {name}")
        self.call(f"requests {which}", lambda: self.requests[which].put((name, reply)))
        self.kernel.charge(0)
        return str(self.call(f"reply to {name}", reply.get))

    def look(self, name: str, which: str) -> object:
        """A table's address is taken, and its memory read, also after that."""
        self.log.touch_from_now_on(f"table {which}")
        first = self.images[which]
        self.kernel.charge(0)
        self.log.touch("nothing of its own " + name, READS)
        return first, self.images[which]

    def load(self, name: str, which: str) -> None:
        self.log.touch(f"table {which}")
        self.images[which] += 1

    def sleep(self, name: str, which: str) -> None:
        self.kernel.delay(US // 2)

    def spawn(self, name: str, which: str) -> None:
        self.start(f"{name}'s", [("write", which)])

    @property
    def outcome(self) -> object:
        return sorted(self.values.items()), sorted((name, tuple(seen)) for name, seen in self.seen.items())


def fly(program: Program, schedule: Schedule, context: str = "greenlet", world: type[World] = World) -> Flown:
    recorded = NotingPolicy(schedule.policy())
    log = StepLog()
    with make_kernel(context, None, recorded, derived=log.kernel) as kernel:
        flown = world(kernel, program, log)
        kernel.run(1000 * US)
        return Flown(repr(flown.outcome), recorded, flown.log.steps)


def random_program(seed: int, kinds: tuple[str, ...], tasks: int, most: int) -> Program:
    random = Random(seed)
    return [[(random.choice(kinds), random.choice("xy")) for _ in range(random.randint(1, most))] for _ in range(tasks)]


class Seen(NamedTuple):
    """Result of a search: outcomes, orders, and runs."""

    outcomes: set[object]
    orders: set[frozenset[int]]
    flights: int


def all_schedules(program: Program, most: int) -> Seen | None:
    """Try every schedule. Returns None if there are more than `most`."""
    tree, seen = DepthFirst(99, 99), Seen(set(), set(), 0)
    while (schedule := tree.next()) is not None:
        flown = fly(program, schedule)
        seen.outcomes.add(flown.outcome)
        seen.orders.add(Order(flown.steps).names)
        seen = seen._replace(flights=seen.flights + 1)
        if seen.flights > most:
            return None
        tree.learn(schedule, flown.recorded.widths, flown.recorded.running)
    return seen


def all_orders(program: Program, context: str = "greenlet", most: int = 5000) -> tuple[Seen, OrderSearch]:
    search, seen = OrderSearch(Schedule()), Seen(set(), set(), 0)
    while (schedule := search.next()) is not None and seen.flights < most:
        flown = fly(program, schedule, context)
        seen.outcomes.add(flown.outcome)
        seen.orders.add(Order(flown.steps).names)
        search.tell(seen.flights, Verdict(schedule, steps=flown.steps))
        seen = seen._replace(flights=seen.flights + 1)
    return seen, search


DATA = ("write", "read")
ALL = (*DATA, "lock", "leave", "put", "get", "give", "take", "sleep", "spawn")
NODES = (*DATA, "send", "ask", "wait", "notify")
TABLES = ("look", "load", "sleep", "read")


def same_as_all_schedules(program: Program, most: int = 400) -> tuple[int, int] | None:
    """Return how many runs each search took, or None if there are too many schedules to try them all."""
    every = all_schedules(program, most)
    if every is None:
        return None
    found, search = all_orders(program)
    assert search.exhausted
    assert found.outcomes == every.outcomes
    assert found.orders == every.orders
    assert search.orders == len(every.orders)
    assert found.flights <= search.orders + search.astray + search.orders // 4
    return found.flights, every.flights


@pytest.mark.parametrize("seed", range(4))
def test_order_search_finds_all_outcomes(seed: int) -> None:
    same_as_all_schedules(random_program(seed, DATA, 2, 3))


@pytest.mark.slow
@pytest.mark.parametrize("first", range(0, 24, 8))
def test_order_search_finds_all_outcomes_of_random_programs(first: int) -> None:
    taken = []
    for seed in range(first, first + 8):
        some = ((DATA, 2, 4), (DATA, 3, 3), (ALL, 2, 3), (ALL, 3, 2), (NODES, 2, 1), (TABLES, 2, 3))
        for kinds, tasks, most in some:
            taken.append(same_as_all_schedules(random_program(seed, kinds, tasks, most)))
    runs = [each for each in taken if each is not None]
    assert len(runs) > 10
    assert 10 * sum(own for own, _ in runs) < sum(every for _, every in runs)


def test_independent_steps_are_flown_once() -> None:
    found, search = all_orders([[("write", "x")] * 5, [("write", "y")] * 5])
    assert found.flights == search.orders == 1
    assert search.exhausted


def test_lock_has_one_order_for_each_sequence_of_owners() -> None:
    found, search = all_orders([[("lock", "x")], [("lock", "x")], [("lock", "x")]])
    assert search.orders == 6
    assert found.flights == 6


def test_release_without_a_scheduling_point_lets_no_task_in() -> None:
    """Steps after a release without a scheduling point belong to it. They may still come after another task's step."""
    found = same_as_all_schedules([[("leave", "x")], [("write", "y")]])
    assert found is not None
    assert found[0] == 2


@pytest.mark.parametrize("other", ["leave", "lock", "read"])
def test_step_after_a_release_may_follow_the_step_of_the_waiter(other: str) -> None:
    assert same_as_all_schedules([[("leave", "x")], [(other, "x"), ("write", "y")]]) is not None


def test_sleep_is_not_a_step() -> None:
    found = same_as_all_schedules([[("load", "y")], [("look", "y"), ("sleep", "x")]])
    assert found is not None
    assert found[0] == 4


def test_threads_and_greenlets_have_the_same_orders() -> None:
    program = random_program(5, ALL, 3, 2)
    assert all_orders(program, "thread", 20)[0] == all_orders(program, "greenlet", 20)[0]


def test_depth_leaves_later_steps_unchanged() -> None:
    program: Program = [[("write", "x")] * 3, [("write", "x")] * 3]
    search, count = OrderSearch(Schedule(), depth=5), 0
    while (schedule := search.next()) is not None:
        search.tell(count, Verdict(schedule, steps=fly(program, schedule).steps))
        count += 1
    assert 1 < count < len(all_orders(program)[0].orders)


def test_order_decided_by_time_alone_is_counted() -> None:
    """A timer comes while another task computes: that one's deed may come after it only if it takes longer."""

    class Computing(World):
        def write(self, name: str, which: str) -> None:
            self.kernel.charge(2 * US if name == "task 1" else 0)
            super().write(name, which)

    def timed(kind: type[World], *programs: Program) -> int:
        search = OrderSearch(Schedule())
        for number, program in enumerate(programs):
            schedule = search.next()
            assert schedule is not None
            search.tell(number, Verdict(schedule, steps=fly(program, schedule, world=kind).steps))
        return search.seen.timed

    program: Program = [[("sleep", "x"), ("write", "x")], [("write", "y"), ("write", "x")]]
    assert timed(World, program) == 0
    assert timed(Computing, [[("sleep", "x"), ("write", "x")], [("write", "x"), ("write", "y")]]) == 1


def test_schedules_do_not_depend_on_the_arrival_of_verdicts() -> None:
    program = random_program(7, ALL, 3, 2)

    def schedules(ahead: int) -> list[Schedule]:
        search, given, told = OrderSearch(Schedule()), list[Schedule](), 0
        while len(given) < 60:
            while len(given) - told < ahead and (schedule := search.next()) is not None:
                given.append(schedule)
            if told == len(given):
                break
            search.tell(told, Verdict(given[told], steps=fly(program, given[told]).steps))
            told += 1
        return given

    assert schedules(1) == schedules(3) == schedules(100)
