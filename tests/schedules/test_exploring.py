"""Scheduling points, policies and the search: races of a few lines that fifo never shows."""

from __future__ import annotations

from collections.abc import Callable

import pytest

from cfepy.extra.exploration.search import DepthFirst
from cfepy.rtos import Kernel, Mutex, NotingPolicy, Queue
from cfepy.schedules import Schedule, make_kernel
from cfepy.trace import Trace

Program = Callable[[Kernel], Callable[[], object]]
"""Puts tasks into a kernel; what it returns tells the outcome after the run."""


def lost_update(kernel: Kernel) -> Callable[[], object]:
    """Make two tasks that each read a number, make a call, and write it back."""
    box = [0]

    def add() -> None:
        value = box[0]
        kernel.charge(0)
        box[0] = value + 1

    kernel.spawn("a", add)
    kernel.spawn("b", add)
    return lambda: box[0]


def lock_order(kernel: Kernel) -> Callable[[], object]:
    """Make two tasks that take two mutexes in opposite order. The one that would close the circle dies."""
    bus, file = Mutex(kernel, "BUS"), Mutex(kernel, "FILE")
    done: list[str] = []

    def work(name: str, first: Mutex, second: Mutex) -> Callable[[], None]:
        def run() -> None:
            first.take()
            kernel.charge(0)
            second.take()
            done.append(name)
            second.give()
            first.give()

        return run

    kernel.on_task_error = lambda task, error: True
    kernel.spawn("a", work("a", bus, file))
    kernel.spawn("b", work("b", file, bus))
    return lambda: len(done)


def urgent_reply(kernel: Kernel) -> Callable[[], object]:
    """Make tasks that send a request before recording it. The answering task has a lower priority."""
    requests: Queue = Queue(kernel, 1)
    asked: list[str] = []
    answers: list[str] = []

    def answer() -> None:
        answers.append("expected" if requests.get() in asked else "unexpected")

    def ask() -> None:
        kernel.delay(1000)
        requests.put("x")
        asked.append("x")

    kernel.spawn("answer", answer, 120)
    kernel.spawn("ask", ask, 100)
    return lambda: answers[0]


def late_timer(kernel: Kernel) -> Callable[[], object]:
    """Make a task that stops a periodic one, in two steps without time between them. The timer is due soon after."""
    state = {"open": True, "running": True}

    def periodic() -> None:
        while state["running"]:
            kernel.delay(1_000_000)
            assert state["open"] or not state["running"], "used after close"

    def stop() -> None:
        kernel.delay(999_000)
        state["open"] = False
        kernel.charge(0)
        state["running"] = False

    failed: list[str] = []
    kernel.on_task_error = lambda task, error: not failed.append(str(error))
    kernel.spawn("periodic", periodic, 50)
    kernel.spawn("stop", stop)
    return lambda: len(failed)


def fly(program: Program, schedule: Schedule, context: str = "greenlet") -> tuple[object, NotingPolicy, str]:
    """Outcome, decisions and digest of one run."""
    recorded, trace = NotingPolicy(schedule.policy()), Trace()
    with make_kernel(context, trace, recorded) as kernel:
        outcome = program(kernel)
        kernel.run(5_000_000)
        return outcome(), recorded, trace.digest()


CASES = [(lost_update, "", 1), (lock_order, "", 1), (urgent_reply, ":any", "unexpected"), (late_timer, ":hold=2us", 1)]


@pytest.mark.parametrize(("program", "options", "bad"), CASES)
def test_race_is_hidden_under_fifo_and_found_by_each_policy(
    program: Program, options: str, bad: object, context: str
) -> None:
    assert fly(program, Schedule(), context)[0] != bad
    for text in ("random:{}", "pct:{}:2:10"):
        schedules = [Schedule.parse(text.format(seed) + options) for seed in range(60)]
        found = next(schedule for schedule in schedules if fly(program, schedule, context)[0] == bad)
        outcome, recorded, digest = fly(program, found, context)
        again = found.at(recorded.deviations)
        assert fly(program, again, "thread")[::2] == (bad, digest)
    assert outcome == bad


@pytest.mark.parametrize(("program", "options", "bad"), CASES)
def test_depth_first_search_finds_the_race_and_ends(program: Program, options: str, bad: object) -> None:
    search = DepthFirst(1, 1, Schedule.parse("at" + options))
    outcomes = {}
    while (schedule := search.next()) is not None:
        assert not search.exhausted
        outcome, recorded, _ = fly(program, schedule)
        assert schedule.text() not in outcomes
        outcomes[schedule.text()] = outcome
        search.learn(schedule, recorded.widths, recorded.running)
    assert search.exhausted
    assert bad in outcomes.values()
    first = next(text for text, outcome in outcomes.items() if outcome == bad)
    assert len(Schedule.parse(first).deviations) == 1


def test_depth_first_search_counts_preemptions_and_reorderings_separately() -> None:
    def three(kernel: Kernel) -> Callable[[], object]:
        order: list[str] = []
        for name in "abc":
            kernel.spawn(name, lambda name=name: order.append(name))  # type: ignore[misc]
        return lambda: "".join(order)

    def orders(preemptions: int, reorderings: int) -> list[object]:
        search, found = DepthFirst(preemptions, reorderings), []
        while (schedule := search.next()) is not None:
            outcome, recorded, _ = fly(three, schedule)
            assert recorded.preemptions == 0
            found.append(outcome)
            search.learn(schedule, recorded.widths, recorded.running)
        return found

    assert orders(2, 0) == ["abc"]
    assert orders(0, 1) == ["abc", "bac", "cab", "acb"]
    assert sorted(orders(0, 2)) == ["abc", "acb", "bac", "bca", "cab", "cba"]  # type: ignore[type-var]


def test_depth_first_search_accepts_results_in_any_order() -> None:
    search = DepthFirst(1, 0)
    first = search.next()
    assert first is not None
    assert search.next() is None, "nothing is known of the first run yet"
    search.learn(first, [2, 3], [True, True])
    given = [search.next(), search.next(), search.next()]
    assert [each.text() for each in given if each is not None] == ["at:0=1", "at:1=1", "at:1=2"]
    for schedule in reversed(given):
        assert not search.exhausted
        assert schedule is not None
        search.learn(schedule, [2, 3], [True, True])
    assert search.next() is None
    assert search.exhausted


POLLED = [
    "fifo",
    "random:3",
    "at:5=1:hold=100us",
    *(f"pct:{seed}:2:20{each}" for seed in range(5) for each in ("", ":any")),
]


@pytest.mark.parametrize("text", POLLED)
@pytest.mark.parametrize("setter", [80, 100])
def test_polled_task_gets_to_run(text: str, setter: int, context: str) -> None:
    def poll(kernel: Kernel) -> Callable[[], object]:
        box: list[int] = []

        def poller() -> None:
            while not box:
                kernel.charge(1000)

        for _ in range(3):
            kernel.spawn("poller", poller)
        kernel.spawn("setter", lambda: box.append(kernel.now), setter)
        return lambda: box and not kernel.tasks

    assert fly(poll, Schedule.parse(text), context)[0] is True


def test_urgent_task_never_waits_by_default() -> None:
    def ranks(kernel: Kernel) -> Callable[[], object]:
        seen: list[int] = []

        def work(priority: int) -> Callable[[], None]:
            def run() -> None:
                for _ in range(3):
                    seen.append(priority)
                    kernel.charge(0)

            return run

        for priority in (3, 1, 2, 2, 1, 3):
            kernel.spawn(f"p{priority}", work(priority), priority)
        return lambda: seen == sorted(seen)

    seeds = range(20)
    assert all(fly(ranks, Schedule("random", seed))[0] for seed in seeds)
    assert not all(fly(ranks, Schedule("random", seed, any_priority=True))[0] for seed in seeds)


def test_moment_names_the_preempted_task_and_its_successor() -> None:
    _, recorded, _ = fly(lost_update, Schedule.parse("at:1=1"))
    (moment,) = recorded.moments
    assert moment == (1, 1, 0, "a", "b", True, "")
    assert recorded.choices[:2] == [0, 1]
    assert recorded.preemptions == 1
    assert len(recorded.choices) == len(recorded.widths) == len(recorded.running)


def test_task_that_may_start_early_is_a_candidate_until_its_start() -> None:
    log: list[str] = []
    recorded = NotingPolicy(Schedule.parse("at:0=1,2=1").policy())
    kernel = make_kernel(policy=recorded)

    def child() -> None:
        kernel.delay(50)
        kernel.has_started()
        log.append(f"child at {kernel.now}")
        kernel.delay(50)
        log.append(f"child at {kernel.now}")

    def main() -> None:
        kernel.may_start_early("child")
        kernel.spawn("child", child)
        kernel.charge(1)
        kernel.charge(1)
        log.append(f"main at {kernel.now}")

    kernel.spawn("main", main)
    kernel.run()
    assert log == ["child at 0", "main at 2", "child at 50"]
    assert recorded.deviations == {0: 1, 2: 1}


def test_task_that_may_start_early_starts_at_its_time_under_fifo() -> None:
    log: list[int] = []
    recorded = NotingPolicy()
    kernel = make_kernel(policy=recorded)

    def child() -> None:
        kernel.delay(50)
        log.append(kernel.now)

    def main() -> None:
        kernel.may_start_early("child")
        kernel.spawn("child", child)
        kernel.delay(10)
        kernel.charge(1)

    kernel.spawn("main", main)
    kernel.run()
    assert log == [50]
    assert recorded.widths
    assert not recorded.deviations


def test_late_task_runs_after_the_next_timer(context: str) -> None:
    assert delays(context, "at") == [("first", 10_000), ("second", 11_000)]
    assert delays(context, "moves:first@0/next=hold:late=2us") == [("first", 11_000), ("second", 11_000)]
    assert delays(context, "moves:first@0/next=hold:late=999ns") == delays(context, "at")


def delays(context: str, text: str) -> list[tuple[str, int]]:
    """Return which of two tasks went on when, after delays of 10 and 11 us."""
    ended: list[tuple[str, int]] = []
    with make_kernel(context, None, Schedule.parse(text).policy()) as kernel:

        def work(name: str, after: int) -> None:
            kernel.delay(after)
            ended.append((name, kernel.now))

        kernel.spawn("first", lambda: work("first", 10_000))
        kernel.spawn("second", lambda: work("second", 11_000))
        kernel.run(1_000_000)
    return ended
