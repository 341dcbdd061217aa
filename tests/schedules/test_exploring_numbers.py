"""Guarantees in numbers: the odds of random and PCT, and that the systematic search leaves nothing out.

The seeds are fixed, so a test either always holds or never; bounds leave room of four standard deviations.
"""

from __future__ import annotations

import gc
from collections import Counter
from collections.abc import Callable, Iterator
from functools import partial
from itertools import combinations, groupby, pairwise, permutations
from math import sqrt

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from cfepy.extra.exploration.search import DepthFirst
from cfepy.rtos import Decision, Deviations, Kernel, Mutex, NotingPolicy, Policy, Queue, Semaphore
from cfepy.schedules import ExploringKernel, Schedule, make_kernel
from cfepy.trace import Trace


@pytest.fixture(scope="module", autouse=True)
def _few_objects() -> Iterator[None]:
    """Exclude objects of other tests, because each kernel counts the existing objects."""
    gc.freeze()
    yield
    gc.unfreeze()


Program = Callable[[Kernel, list[str]], None]
SEEDS = 800


def fly(program: Program, policy: Policy | None, context: str = "greenlet") -> tuple[str, NotingPolicy, str]:
    """Return the tasks' output, the decisions, and the digest of the trace."""
    recorded, trace, written = NotingPolicy(policy), Trace(), list[str]()
    with make_kernel(context, trace, recorded) as kernel:
        program(kernel, written)
        kernel.run(1_000_000)
    return "".join(written), recorded, trace.digest()


def walkers(*steps: int) -> Program:
    """Return tasks a, b, ... that write their names that many times, with a scheduling point between two of them."""

    def program(kernel: Kernel, written: list[str]) -> None:
        def walk(name: str, count: int) -> None:
            for step in range(count):
                if step:
                    kernel.charge(0)
                written.append(name)

        for name, count in zip("abcd", steps, strict=False):
            kernel.spawn(name, lambda name=name, count=count: walk(name, count))  # type: ignore[misc]

    return program


def words(*steps: int) -> set[str]:
    """Everything that these tasks can write."""
    letters = "".join(name * count for name, count in zip("abcd", steps, strict=False))
    if len(steps) == 2:
        total = sum(steps)
        places = combinations(range(total), steps[0])
        return {"".join("a" if at in chosen else "b" for at in range(total)) for chosen in places}
    return {"".join(each) for each in permutations(letters)}


def preemptions(word: str, steps: dict[str, int]) -> int:
    """Return how many times a task with unwritten output was preempted."""
    left, count = dict(steps), 0
    runs = [(name, len(list(run))) for name, run in groupby(word)]
    for name, length in runs:
        left[name] -= length
        count += left[name] > 0
    return count


def enough(found: int, odds: float, runs: int = SEEDS) -> bool:
    """Return whether something of at least these odds could have come so rarely."""
    return found >= runs * odds - 4 * sqrt(runs * odds * (1 - odds))


def about(found: int, odds: float, runs: int = SEEDS) -> bool:
    return abs(found - runs * odds) <= 4 * sqrt(runs * odds * (1 - odds))


def test_random_chooses_each_order_equally_often() -> None:
    found = Counter(fly(walkers(1, 1, 1), Schedule.parse(f"random:{seed}").policy())[0] for seed in range(SEEDS))
    assert set(found) == words(1, 1, 1)
    assert all(about(count, 1 / 6) for count in found.values()), found


def test_random_chooses_each_option_equally_often() -> None:
    found: Counter[tuple[int, int]] = Counter()
    for seed in range(100):
        recorded = fly(walkers(3, 3, 3), Schedule.parse(f"random:{seed}").policy())[1]
        found.update(zip(recorded.widths, recorded.choices, strict=True))
    for width in (2, 3):
        runs = sum(found[width, choice] for choice in range(width))
        assert runs > 200
        assert all(about(found[width, choice], 1 / width, runs) for choice in range(width)), found


def test_random_holds_a_task_once_in_sixteen_decisions() -> None:
    def program(kernel: Kernel, written: list[str]) -> None:
        def work() -> None:
            for _ in range(100):
                kernel.charge(0)

        def tick() -> None:
            for _ in range(1000):
                kernel.delay(10)

        kernel.spawn("ticks", tick, 50)
        kernel.spawn("work", work)

    held = runs = 0
    for seed in range(20):
        recorded = fly(program, Schedule.parse(f"random:{seed}:hold=10ns").policy())[1]
        runs += len(recorded.choices)
        held += sum(recorded.choices)
        assert set(recorded.widths) == {2}
    assert runs >= 2000
    assert about(held, 1 / 16, runs)


@pytest.mark.parametrize("depth", [1, 2, 3])
def test_pct_finds_a_bug_of_its_depth_at_the_guaranteed_rate(depth: int) -> None:
    """Two tasks with 5 + 5 steps: a bug of `depth` ordered events has odds of at least 1 / (n k^(d-1))."""
    program, steps = walkers(5, 5), {"a": 5, "b": 5}
    decisions = len(fly(program, None)[1].choices)
    longest = max(len(fly(program, Schedule.parse(f"random:{seed}").policy())[1].choices) for seed in range(50))
    assert 5 <= decisions <= longest <= 10
    found = Counter(fly(program, Schedule.parse(f"pct:{seed}:{depth}:{longest}").policy())[0] for seed in range(SEEDS))
    wanted = [word for word in words(5, 5) if preemptions(word, steps) == depth - 1 and word[0] == "a"]
    wanted = [word for word in wanted if len(list(groupby(word))) == depth + 1]
    assert len(wanted) == {1: 1, 2: 4, 3: 16}[depth]
    for word in wanted:
        assert enough(found[word], 1 / (2 * longest ** (depth - 1))), (word, found[word])
    assert max(preemptions(word, steps) for word in found) == depth - 1


def all_words(steps: tuple[int, ...], most_preemptions: int, most_reorderings: int) -> list[str]:
    search, found, seen = DepthFirst(most_preemptions, most_reorderings), list[str](), set[tuple[int, ...]]()
    while (schedule := search.next()) is not None:
        word, recorded, _ = fly(walkers(*steps), schedule.policy())
        assert tuple(recorded.choices) not in seen, "a schedule came twice"
        assert recorded.deviations == dict(schedule.deviations), "a deviation was not possible"
        seen.add(tuple(recorded.choices))
        found.append(word)
        search.learn(schedule, recorded.widths, recorded.running)
    assert search.exhausted
    return found


@pytest.mark.parametrize("steps", [(1, 1), (3, 3), (2, 5), (1, 1, 1), (2, 2, 2)])
def test_unbounded_search_gives_every_order_once(steps: tuple[int, ...]) -> None:
    found = all_words(steps, 99, 99)
    assert set(found) == words(*steps)
    assert len(found) == len(set(found))


@pytest.mark.parametrize("steps", [(4, 4), (2, 1, 1), (2, 2, 1)])
@pytest.mark.parametrize("most", [0, 1, 2])
def test_bounded_search_gives_every_order_within_its_bound(steps: tuple[int, ...], most: int) -> None:
    found = all_words(steps, most, 99)
    counts = dict(zip("abcd", steps, strict=False))
    wanted = {word for word in words(*steps) if preemptions(word, counts) <= most}
    assert set(found) == wanted
    assert len(found) == len(wanted)


def test_decision_names_the_task_that_yielded_once() -> None:
    told: list[str | None] = []

    class Listening(Policy):
        def choose(self, decision: Decision) -> int:
            told.append(None if decision.left is None else decision.left.name)
            return 0

    def program(kernel: Kernel, written: list[str]) -> None:
        def polite() -> None:
            kernel.yield_cpu()
            kernel.charge(0)

        for name in "abc":
            kernel.spawn(name, polite)

    fly(program, Listening())
    assert told == [None, "a", "b", "c", None, None, None]


@pytest.mark.parametrize("options", ["", ":hold=1us"])
def test_ending_task_is_not_preempted(options: str, context: str) -> None:
    schedule = Schedule.parse("at:" + ",".join(f"{number}=1" for number in range(20)) + options)

    def program(kernel: Kernel, written: list[str]) -> None:
        def victim() -> None:
            try:
                kernel.delay(500)
            finally:
                written.append("(")
                assert isinstance(kernel, ExploringKernel)
                kernel.point()
                kernel.charge(0)
                written.append(")")

        def killer() -> None:
            kernel.delay(100)
            kernel.kill(doomed)
            written.append("k")

        doomed = kernel.spawn("victim", victim)
        kernel.spawn("killer", killer)
        kernel.spawn("other", lambda: (kernel.delay(100), written.append("o")))  # type: ignore[func-returns-value]

    word = fly(program, schedule.policy(), context)[0]
    assert "()" in word
    assert sorted(word) == sorted("()ko")


ACTIONS = st.sampled_from(
    ["charge", "slice", "delay", "put", "get", "lock", "give", "take", "yield", "spawn", "urgent"]
)
PROGRAMS = st.lists(
    st.tuples(st.sampled_from([90, 100, 100, 100]), st.lists(ACTIONS, min_size=1, max_size=6)), min_size=2, max_size=4
)


def made_of(tasks: list[tuple[int, list[str]]]) -> Program:
    """Return a program of kernel calls of all sorts."""

    def program(kernel: Kernel, written: list[str]) -> None:
        queue, mutex, semaphore = Queue(kernel, 2), Mutex(kernel), Semaphore(kernel, 0, 1)

        def locked() -> None:
            mutex.take()
            kernel.charge(1000)
            mutex.give()

        acts: dict[str, Callable[[], object]] = {
            "charge": lambda: kernel.charge(1000),
            "slice": lambda: kernel.charge(30_000),
            "delay": lambda: kernel.delay(1500),
            "put": lambda: queue.put("x"),
            "get": lambda: queue.get(5000),
            "lock": locked,
            "give": semaphore.give,
            "take": lambda: semaphore.take(3000),
            "yield": kernel.yield_cpu,
            "spawn": lambda: kernel.spawn("child", lambda: written.append("c")),
            "urgent": lambda: kernel.spawn("urgent", lambda: written.append("u"), 50),
        }

        def work(name: str, todo: list[str]) -> None:
            for each in todo:
                acts[each]()
                written.append(name)

        for name, (priority, todo) in zip("wxyz", tasks, strict=False):
            kernel.spawn(name, lambda name=name, todo=todo: work(name, todo), priority)  # type: ignore[misc]

    return program


def plain(program: Program) -> tuple[str, str]:
    trace, written = Trace(), list[str]()
    with make_kernel("greenlet", trace) as kernel:
        program(kernel, written)
        kernel.run(1_000_000)
    return "".join(written), trace.digest()


@settings(max_examples=30, deadline=None)
@given(PROGRAMS, st.integers(0, 1000), st.sampled_from(["", ":any", ":hold=2us", ":from=2us"]))
def test_program_without_deviations_equals_fifo_and_any_run_can_be_reproduced(
    tasks: list[tuple[int, list[str]]], seed: int, options: str
) -> None:
    program = made_of(tasks)
    assert fly(program, Schedule.parse("at").policy())[::2] == plain(program)
    for text in (f"random:{seed}{options}", f"pct:{seed}:3:20{options}"):
        schedule = Schedule.parse(text)
        written, recorded, digest = fly(program, schedule.policy())
        again = schedule.at(recorded.deviations)
        for context in ("thread", "greenlet"):
            assert fly(program, again.policy(), context)[::2] == (written, digest)
        assert fly(program, schedule.policy(), "thread")[::2] == (written, digest)


def test_choice_beyond_the_options_becomes_the_last_option() -> None:
    recorded = fly(walkers(1, 1, 1), Deviations({0: 9}))[1]
    assert recorded.choices[0] == 2
    assert recorded.deviations == {0: 2}


def crowd(count: int) -> Program:
    """Return a starter and `count` tasks with two steps each.

    A digit is the number of first steps before a second step.

    The started tasks may run while the starter starts others.
    """

    def program(kernel: Kernel, written: list[str]) -> None:
        arrived = [0]

        def come() -> None:
            kernel.preempt()
            arrived[0] += 1
            kernel.preempt()
            written.append(str(arrived[0]))

        def start() -> None:
            for number in range(count):
                kernel.spawn(f"{number}", come, 100)
                kernel.preempt()

        kernel.spawn("starter", start, 100)

    return program


def test_random_switches_less_often_with_points_between_calls() -> None:
    def changes(text: str) -> int:
        words = [fly(walkers(8, 8), Schedule.parse(f"random:{seed}{text}").policy())[0] for seed in range(60)]
        return sum(before != after for word in words for before, after in pairwise(word))

    assert changes(":points=attributes") < 0.7 * changes("")
    words = {fly(walkers(2, 2), Schedule.parse(f"random:{seed}:points=attributes").policy())[0] for seed in range(200)}
    assert words == {"aabb", "abab", "abba", "baab", "baba", "bbaa"}


def test_random_starts_all_tasks_before_a_long_stretch() -> None:
    def program(kernel: Kernel, written: list[str]) -> None:
        started = [0]

        def go_on() -> None:
            kernel.preempt()
            kernel.preempt()
            written.append(str(started[0]))

        def start() -> None:
            for number in range(6):
                kernel.spawn(f"{number}", go_on, 100)
                started[0] += 1
                kernel.preempt()

        kernel.spawn("starter", start, 100)

    def often(text: str) -> int:
        """In how many schedules all had been started before the first one came far."""
        words = [fly(program, Schedule.parse(f"random:{seed}{text}").policy())[0] for seed in range(100)]
        return sum(word[0] == "6" for word in words)

    assert often(":points=attributes") > 40
    assert often("") < 20


def test_abreast_makes_equal_tasks_collide() -> None:
    found = Counter(fly(crowd(6), Schedule.parse(f"abreast:{seed}").policy())[0] for seed in range(100))
    assert found["666666"] > 10  # all are ready before the first one continues
    assert sum(word.startswith("1") for word in found) > 5
    by_chance = Counter(fly(crowd(6), Schedule.parse(f"random:{seed}").policy())[0] for seed in range(100))
    assert by_chance["666666"] < 3


def test_abreast_reaches_every_order_of_two_tasks() -> None:
    words = {fly(walkers(2, 2), Schedule.parse(f"abreast:{seed}").policy())[0] for seed in range(200)}
    assert words == {"aabb", "abab", "abba", "baab", "baba", "bbaa"}


def workers_and_reader(count: int) -> Program:
    """Return many tasks with two steps each, and a reader, started last, which writes an `x` if it sees only the
    first step."""

    def program(kernel: Kernel, written: list[str]) -> None:
        first, second = [False], [False]

        def work() -> None:
            kernel.preempt()
            first[0] = True
            kernel.preempt()
            second[0] = True

        def read() -> None:
            kernel.preempt()
            was_done = first[0]
            kernel.preempt()
            written.append("x" if was_done and not second[0] else "-")

        def start() -> None:
            for number in range(count):
                kernel.spawn(f"{number}", work, 100)
                kernel.preempt()
            kernel.spawn("reader", read, 100)

        kernel.spawn("starter", start, 100)

    return program


@pytest.mark.slow
def test_abreast_pairs_tasks_with_different_code() -> None:
    schedules = [Schedule.parse(f"abreast:{seed}") for seed in range(300)]
    assert sum(fly(workers_and_reader(19), each.policy())[0] == "x" for each in schedules) > 5
    by_chance = [Schedule.parse(f"random:{seed}") for seed in range(300)]
    assert not any(fly(workers_and_reader(19), each.policy())[0] == "x" for each in by_chance)


def test_abreast_lets_a_starting_task_continue_beyond_its_time_slice() -> None:
    """Otherwise it would count as polling, and the tasks that it has not started would never meet the others."""
    schedule = next(each for each in map("abreast:{}".format, range(100)) if _is_together(each, slice_us=0))
    assert _is_together(schedule, slice_us=20_000)


def _is_together(schedule: str, slice_us: int) -> bool:
    """Return whether all of six tasks have done the first step before any does its second."""

    def program(kernel: Kernel, written: list[str]) -> None:
        def come() -> None:
            kernel.preempt()
            written.append("1")
            kernel.preempt()
            written.append("2")

        def start() -> None:
            for number in range(6):
                kernel.spawn(f"{number}", come, 100)
                kernel.charge(slice_us * 1000)

        kernel.spawn("starter", start, 100)

    with make_kernel("greenlet", Trace(), Schedule.parse(schedule).policy()) as kernel:
        written = list[str]()
        program(kernel, written)
        kernel.run(1_000_000_000)
    return "".join(written) == "111111222222"


def test_polling_task_does_not_starve_others() -> None:
    def program(kernel: Kernel, written: list[str]) -> None:
        def poll() -> None:
            for name in "ab":
                kernel.spawn(name, partial(written.append, name), 100)
            while len(written) < 2:
                kernel.charge(1000)

        kernel.spawn("poller", poll, 100)

    for seed in range(20):
        with make_kernel("greenlet", Trace(), Schedule.parse(f"abreast:{seed}").policy()) as kernel:
            written = list[str]()
            program(kernel, written)
            kernel.run(1_000_000_000)
        assert sorted(written) == ["a", "b"]
