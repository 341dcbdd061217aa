"""Random programs of tasks that use everything the kernel has: the run must be the same on both contexts, in slices,
in every repetition and in a replay, and the kernel's promises must hold in each of them."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cfepy.rtos import (
    DeadlockError,
    Kernel,
    Mutex,
    NotingPolicy,
    Policy,
    Queue,
    SeededRandom,
    Semaphore,
    Task,
    WaitList,
)
from cfepy.schedules import Schedule, make_kernel
from cfepy.trace import Trace

pytest.importorskip("greenlet")

OBJECTS = 2
END_NS = 6_000_000
COMPUTE_NS = 3000  # times 40 at most: more than a turn among equals
QUICK = settings(max_examples=40, deadline=None)

INDEX = st.integers(0, OBJECTS - 1)
TIME = st.integers(0, 40)
OPERATIONS = st.one_of(
    st.tuples(st.sampled_from(["delay", "charge", "compute"]), TIME),
    st.tuples(st.just("put"), INDEX),
    st.tuples(st.sampled_from(["get", "take", "lock"]), INDEX, st.integers(-1, 30)),
    st.tuples(st.sampled_from(["give", "flush", "wait", "wake_first", "wake_all"]), INDEX),
    st.tuples(st.sampled_from(["yield", "unlock", "stop_one", "exit"])),
    st.tuples(st.just("priority"), st.integers(1, 6)),
    st.tuples(st.just("spawn"), st.integers(1, 6)),
)
TASKS = st.lists(st.tuples(st.integers(1, 6), st.lists(OPERATIONS, max_size=12)), min_size=1, max_size=5)
ENDS = st.lists(st.one_of(st.integers(0, 100), st.integers(0, END_NS)), max_size=20).map(sorted)
SCHEDULES = st.builds(
    Schedule,
    st.sampled_from(["fifo", "random", "pct"]),
    seed=st.integers(0, 1000),
    depth=st.integers(1, 4),
    steps=st.integers(1, 60),
    any_priority=st.booleans(),
    hold_ns=st.sampled_from([0, 10, 5000]),
    from_ns=st.sampled_from([0, 30]),
)
Program = Sequence[tuple[int, Sequence[tuple[object, ...]]]]


@dataclass
class Outcome:
    """Observations of a program's run."""

    digest: str
    log: list[tuple[object, ...]] = field(default_factory=list)
    now: int = 0
    choices: list[int] = field(default_factory=list)


class Machine:
    """Runs one program on one kernel, and checks the invariants."""

    def __init__(self, kernel: Kernel, program: Program) -> None:
        self.kernel = kernel
        self.queues = [Queue(kernel, 2, f"q{index}") for index in range(OBJECTS)]
        self.semaphores = [Semaphore(kernel, 0, 1, f"s{index}") for index in range(OBJECTS)]
        self.mutexes = [Mutex(kernel, f"m{index}") for index in range(OBJECTS)]
        self.signals = [WaitList(f"w{index}") for index in range(OBJECTS)]
        self.put_items: list[list[int]] = [[] for _ in range(OBJECTS)]
        self.got_items: list[list[int]] = [[] for _ in range(OBJECTS)]
        self.tasks: list[Task] = []
        self.log: list[tuple[object, ...]] = []
        self.last_now = 0
        self.strict = kernel.policy is None or not kernel.policy.any_priority
        for number, (priority, operations) in enumerate(program):
            self.start(f"t{number}", operations, priority)

    def start(self, name: str, operations: Sequence[tuple[object, ...]], priority: int) -> None:
        self.tasks.append(self.kernel.spawn(name, lambda: self.live(operations), priority))

    def live(self, operations: Sequence[tuple[object, ...]]) -> None:
        held: list[Mutex] = []
        for step, (operation, *arguments) in enumerate(operations):
            result = getattr(self, f"do_{operation}")(held, *arguments)
            self.check()
            self.log.append((self.kernel.now, self.kernel.current.name, step, operation, repr(result)))

    def check(self) -> None:
        """Check that the running task has the highest priority, and that time never goes back."""
        kernel = self.kernel
        current = kernel.current
        assert kernel.now >= self.last_now
        self.last_now = kernel.now
        if self.strict:
            assert not kernel.ready or kernel.ready[0][0] >= current.priority
        for mutex in self.mutexes:
            if mutex.owner is not None and mutex.waits:
                assert mutex.owner.priority <= mutex.waits[0].priority

    def do_delay(self, held: list[Mutex], time: int) -> None:
        start = self.kernel.now
        self.kernel.delay(time)
        assert self.kernel.now >= start + max(time, 1)

    def do_charge(self, held: list[Mutex], time: int) -> None:
        self.kernel.charge(time)

    def do_compute(self, held: list[Mutex], time: int) -> None:
        self.kernel.charge(time * COMPUTE_NS)

    def do_put(self, held: list[Mutex], index: int) -> bool:
        items = self.put_items[index]
        items.append(len(items))
        if self.queues[index].put(len(items) - 1):
            return True
        items.pop()
        return False

    def do_get(self, held: list[Mutex], index: int, timeout: int) -> object:
        item = self.queues[index].get(timeout)
        if type(item) is int:
            self.got_items[index].append(item)
        return item

    def do_take(self, held: list[Mutex], index: int, timeout: int) -> bool:
        return self.semaphores[index].take(timeout)

    def do_give(self, held: list[Mutex], index: int) -> None:
        self.semaphores[index].give()

    def do_flush(self, held: list[Mutex], index: int) -> None:
        self.semaphores[index].flush()

    def do_lock(self, held: list[Mutex], index: int, timeout: int) -> str:
        try:
            self.mutexes[index].take()
        except DeadlockError:
            return "deadlock"
        held.append(self.mutexes[index])
        assert self.mutexes[index].owner is self.kernel.current
        return "locked"

    def do_unlock(self, held: list[Mutex]) -> bool:
        return bool(held) and held.pop().give()

    def do_wait(self, held: list[Mutex], index: int) -> object:
        return self.kernel.wait_on(self.signals[index], 25)

    def do_wake_first(self, held: list[Mutex], index: int) -> bool:
        return self.kernel.wake_first(self.signals[index], "one")

    def do_wake_all(self, held: list[Mutex], index: int) -> int:
        return self.kernel.wake_all(self.signals[index], "all")

    def do_yield(self, held: list[Mutex]) -> None:
        self.kernel.yield_cpu()

    def do_exit(self, held: list[Mutex]) -> None:
        self.kernel.exit_task()

    def do_stop_one(self, held: list[Mutex]) -> str:
        victim = next((task for task in self.tasks if not task.done and task is not self.kernel.current), None)
        if victim is None:
            return "nobody"
        self.kernel.kill(victim)
        assert victim.done
        return victim.name

    def do_priority(self, held: list[Mutex], priority: int) -> None:
        self.kernel.set_priority(self.kernel.current, priority)

    def do_spawn(self, held: list[Mutex], priority: int) -> None:
        if len(self.tasks) < 12:
            self.start(f"t{len(self.tasks)}", [("delay", 3), ("put", 0), ("give", 1)], priority)


def execute(
    program: Program, context: str, ends: Sequence[int] = (END_NS,), policy: Policy | None = None, **board: int
) -> Outcome:
    """Run a program to its end. Returns its observations."""
    trace = Trace()
    with make_kernel(context, trace, policy, **board) as kernel:
        machine = Machine(kernel, program)
        for end in ends:
            kernel.run(until_ns=end)
        outcome = Outcome(trace.digest(), list(machine.log), kernel.now)
        for queue, put, got in zip(machine.queues, machine.put_items, machine.got_items, strict=True):
            assert sorted(got) == sorted(set(got)), "an item came twice"
            assert set(got) | set(queue.items) <= set(put)
    return outcome


@QUICK
@given(TASKS)
def test_threads_and_greenlets_give_the_same_run(program: Program) -> None:
    assert execute(program, "thread") == execute(program, "greenlet")


@QUICK
@given(TASKS)
def test_every_repetition_gives_the_same_run(program: Program) -> None:
    assert len({execute(program, "greenlet").digest for _ in range(3)}) == 1


@QUICK
@given(TASKS, ENDS)
def test_slices_give_the_same_run(program: Program, ends: list[int]) -> None:
    assert execute(program, "greenlet", [*ends, END_NS]) == execute(program, "greenlet")


@QUICK
@given(TASKS, st.integers(0, 3), st.integers(0, 20), ENDS)
def test_slices_give_the_same_run_on_a_board(program: Program, cost: int, tick: int, ends: list[int]) -> None:
    whole = execute(program, "greenlet", switch_cost_ns=cost, tick_ns=tick)
    assert execute(program, "thread", [*ends, END_NS], switch_cost_ns=cost, tick_ns=tick) == whole


@QUICK
@given(TASKS, SCHEDULES, ENDS)
def test_every_schedule_can_be_reproduced(program: Program, schedule: Schedule, ends: list[int]) -> None:
    """It is repeated as recorded, as deviations from fifo, on the other context, and in slices."""
    recorded = NotingPolicy(schedule.policy())
    first = execute(program, "greenlet", policy=recorded)
    again = schedule.at(recorded.deviations)
    assert execute(program, "thread", policy=schedule.policy() or Policy()) == first
    assert execute(program, "thread", policy=again.policy()) == first
    assert execute(program, "greenlet", [*ends, END_NS], policy=again.policy()) == first


@QUICK
@given(TASKS, st.integers(0, 3), st.integers(0, 20))
def test_first_candidate_is_the_order_without_a_policy(program: Program, cost: int, tick: int) -> None:
    plain = execute(program, "greenlet", switch_cost_ns=cost, tick_ns=tick)
    assert execute(program, "greenlet", policy=Policy(), switch_cost_ns=cost, tick_ns=tick) == plain
    explored = Policy(any_priority=True, hold_ns=END_NS)
    assert execute(program, "greenlet", policy=explored, switch_cost_ns=cost, tick_ns=tick) == plain


@settings(max_examples=25, deadline=None)
@given(st.lists(st.integers(1, 5), min_size=2, max_size=8), st.integers(0, 99))
def test_policy_never_violates_priorities(priorities: list[int], seed: int) -> None:
    order: list[int] = []

    def noter(priority: int) -> Callable[[], None]:
        return lambda: order.append(priority)

    with make_kernel("greenlet", policy=SeededRandom(seed)) as kernel:
        for priority in priorities:
            kernel.spawn(f"p{priority}", noter(priority), priority)
        kernel.run()
    assert order == sorted(priorities)
