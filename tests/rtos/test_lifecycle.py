"""Ends of tasks: return, error, kill, refusal to die, and Ctrl-C on the host."""

from __future__ import annotations

import gc
import signal
import threading
import weakref
from itertools import count

import pytest

from cfepy.rtos import Kernel, Queue, Task, TaskExit, WaitList
from cfepy.rtos.context import drain
from tests.rtos.helpers import Log


def test_killed_task_unwinds_before_kill_returns(kernel: Kernel, log: Log) -> None:
    def victim() -> None:
        try:
            with pytest.raises(TaskExit) as caught:
                kernel.delay(1000)
            log("unwinding")
            raise caught.value
        finally:
            log("finally")

    task = kernel.spawn("victim", victim)
    kernel.spawn("killer", lambda: (kernel.delay(5), kernel.kill(task), log("killed")))
    kernel.run()
    assert log == ["unwinding", "finally", "killed"]
    assert task.done
    assert kernel.now == 5


def test_interrupted_task_continues(kernel: Kernel, log: Log) -> None:
    def sleeper() -> None:
        try:
            kernel.delay(1000)
        except KeyError as error:
            log(f"{error} at {kernel.now}")
        kernel.delay(10)
        log(f"done at {kernel.now}")

    task = kernel.spawn("sleeper", sleeper)
    kernel.spawn("other", lambda: (kernel.delay(5), kernel.interrupt(task, KeyError(1)), log("interrupted")))
    kernel.run()
    assert log == ["interrupted", "1 at 5", "done at 15"]


def test_interrupted_wait_leaves_its_list(kernel: Kernel, log: Log) -> None:
    waits = WaitList("something")

    def waiter() -> None:
        with pytest.raises(KeyError):
            kernel.wait_on(waits)
        log(f"{len(waits)} waiting")

    task = kernel.spawn("waiter", waiter)
    kernel.spawn("other", lambda: (kernel.interrupt(task, KeyError()), kernel.wake_first(waits)))
    kernel.run()
    assert log == ["0 waiting"]


def test_preempted_task_can_be_interrupted(kernel: Kernel, log: Log) -> None:
    def urgent() -> None:
        kernel.delay(3)
        assert not kernel.is_waiting(task)
        kernel.interrupt(task, KeyError())

    def work() -> None:
        while kernel.now < 100:
            kernel.charge(1)

    def worker() -> None:
        with pytest.raises(KeyError):
            work()
        log(f"at {kernel.now}")

    task = kernel.spawn("worker", worker, 100)
    kernel.spawn("urgent", urgent, 50)
    kernel.run()
    assert log == ["at 3"]


def test_kill_has_precedence_over_an_interruption(kernel: Kernel, log: Log) -> None:
    def victim() -> None:
        try:
            kernel.delay(10)
        except KeyError:
            log("interrupted")

    task = kernel.spawn("victim", victim, 100)
    kernel.spawn("killer", lambda: (kernel.delay(1), kernel.interrupt(task, KeyError()), kernel.kill(task)), 50)
    kernel.run()
    assert log == []
    assert task.done


def test_task_killed_before_it_began_never_runs(kernel: Kernel, log: Log) -> None:
    task = kernel.spawn("victim", log.writer("ran"))
    kernel.kill(task)
    kernel.run()
    assert log == []
    assert task.done


def test_task_that_kills_itself_does_not_continue(kernel: Kernel, log: Log) -> None:
    kernel.spawn("suicide", lambda: (kernel.kill(kernel.current), log("alive")))
    kernel.run()
    assert log == []


def test_kill_of_an_ended_task_does_nothing(kernel: Kernel) -> None:
    task = kernel.spawn("short", lambda: None)
    kernel.run()
    kernel.kill(task)
    assert task.done


def test_killed_ready_task_leaves_the_ready_queue(kernel: Kernel, log: Log) -> None:
    task = kernel.spawn("victim", lambda: (kernel.yield_cpu(), log("victim")), 50)
    kernel.spawn("killer", lambda: kernel.kill(task), 50)
    kernel.run()
    assert log == []


def test_killed_waiter_leaves_the_wait_list(kernel: Kernel) -> None:
    queue = Queue(kernel, 1)
    task = kernel.spawn("victim", queue.get)
    kernel.run(until_ns=1)
    kernel.kill(task)
    queue.put("kept")
    assert list(queue.items) == ["kept"]


def test_wait_in_a_finally_of_a_killed_task_is_refused(kernel: Kernel, log: Log) -> None:
    def victim() -> None:
        try:
            kernel.delay(1000)
        finally:
            log("cleaning")
            kernel.delay(1)
            log("waited")

    task = kernel.spawn("victim", victim)
    kernel.run(until_ns=1)
    kernel.kill(task)
    assert log == ["cleaning"]
    assert task.done


def test_dying_task_may_wake_others(kernel: Kernel, log: Log) -> None:
    queue = Queue(kernel, 1)

    def victim() -> None:
        try:
            kernel.delay(1000)
        finally:
            queue.put("last words")

    kernel.spawn("heir", lambda: log(queue.get()), 10)
    task = kernel.spawn("victim", victim, 50)
    kernel.run(until_ns=1)
    kernel.kill(task)
    kernel.run()
    assert log == ["last words"]


def test_task_that_catches_every_exit_is_abandoned(kernel: Kernel) -> None:
    def stubborn() -> None:
        while True:
            try:
                kernel.delay(10)
            except BaseException:
                continue

    task = kernel.spawn("stubborn", stubborn)
    kernel.run(until_ns=15)
    kernel.kill(task)
    assert kernel.stuck == [task]
    assert task not in kernel.tasks
    kernel.run(until_ns=100)
    assert kernel.now == 100


def test_error_in_a_task_is_raised_by_run(kernel: Kernel) -> None:
    def faulty() -> None:
        kernel.delay(3)
        raise ValueError("broken")

    kernel.spawn("faulty", faulty)
    kernel.spawn("other", lambda: kernel.delay(100))
    with pytest.raises(ValueError, match="broken"):
        kernel.run()
    assert kernel.now == 3
    kernel.run()
    assert kernel.now == 100


def test_error_hook_lets_the_run_continue(kernel: Kernel) -> None:
    seen: list[tuple[str, str]] = []

    def hook(task: Task, error: BaseException) -> bool:
        seen.append((task.name, str(error)))
        return True

    def faulty() -> None:
        raise ValueError("broken")

    kernel.on_task_error = hook
    task = kernel.spawn("faulty", faulty)
    kernel.run()
    assert seen == [("faulty", "broken")]
    assert isinstance(task.error, ValueError)


def test_error_in_the_error_hook_is_raised_by_run(kernel: Kernel) -> None:
    def hook(task: Task, error: BaseException) -> bool:
        raise LookupError("in the hook")

    def fail() -> None:
        raise ValueError("in the task")

    kernel.on_task_error = hook
    kernel.spawn("failing", fail)
    with pytest.raises(LookupError, match="in the hook"):
        kernel.run()


def test_errors_of_two_tasks_at_once_are_both_raised(kernel: Kernel) -> None:
    def faulty(text: str) -> None:
        raise ValueError(text)

    for text in ("one", "two"):
        kernel.spawn(text, lambda text=text: faulty(text))
    with pytest.raises(ValueError, match="one"):
        kernel.run()
    with pytest.raises(ValueError, match="two"):
        kernel.run()


def test_shutdown_unwinds_all_tasks_youngest_first(make_kernel: type[Kernel], log: Log) -> None:
    def task(name: str) -> None:
        try:
            kernel.wait_on(WaitList("nothing"))
        finally:
            log(name)

    with make_kernel() as kernel:
        for name in "abc":
            kernel.spawn(name, lambda name=name: task(name))
        kernel.run(until_ns=1)
    assert log == ["c", "b", "a"]
    assert not kernel.tasks


def test_finished_task_keeps_nothing_alive(kernel: Kernel) -> None:
    class Payload:
        pass

    payload = Payload()
    gone = weakref.ref(payload)
    kernel.spawn("user", lambda kept=payload: None)
    del payload
    kernel.run()
    gc.collect()
    assert gone() is None


def test_garbage_is_collected_only_at_fixed_virtual_times(kernel: Kernel) -> None:
    collected_at: list[int] = []

    class Cycle:
        def __init__(self) -> None:
            self.me = self

        def __del__(self) -> None:
            collected_at.append(kernel.now)

    def litterer() -> None:
        for _ in range(40):
            Cycle()
            [[] for _ in range(2000)]
            kernel.delay(1_000_000_000)

    kernel.spawn("litterer", litterer)
    kernel.run(until_ns=35_000_000_000)
    assert set(collected_at) == {10_000_000_000, 20_000_000_000, 30_000_000_000}
    assert gc.isenabled()


def test_long_run_collects_among_all_objects_more_and_more_seldom(
    kernel: Kernel, monkeypatch: pytest.MonkeyPatch
) -> None:
    among_all: list[int] = []
    young: list[int] = []

    def collect(generation: int = 2) -> None:
        (young if generation == 0 else among_all).append(kernel.now)

    monkeypatch.setattr(gc, "collect", collect)
    kernel.spawn("sleeper", lambda: kernel.delay(86_400_000_000_000))
    kernel.run(until_ns=86_400_000_000_000)
    assert sorted(young + among_all) == list(range(10_000_000_000, 86_400_000_000_000, 10_000_000_000))
    assert among_all[:62] == [*range(10_000_000_000, 620_000_000_000, 10_000_000_000), 620_000_000_000]
    assert among_all[-2:] == [84_480_000_000_000, 85_760_000_000_000]
    assert len(among_all) < 500


def test_ctrl_c_reaches_the_host_while_a_task_computes(context: str) -> None:
    main = threading.get_ident()

    def busy() -> None:
        signal.pthread_kill(main, signal.SIGINT)
        while True:
            pass

    with Kernel(context) as kernel:
        task = kernel.spawn("busy", busy)
        with pytest.raises(KeyboardInterrupt):
            kernel.run()
        assert task.done
        assert kernel.current is kernel.host


def test_ctrl_c_while_tasks_switch_leaves_a_usable_kernel(context: str) -> None:
    main = threading.get_ident()
    with Kernel(context) as kernel:

        def ticker(period: int, signal_at: int) -> None:
            for number in count():
                kernel.delay(period)
                if number == signal_at:
                    signal.pthread_kill(main, signal.SIGINT)

        kernel.spawn("ticker", lambda: ticker(10, 50))
        kernel.spawn("other", lambda: ticker(7, -1))
        with pytest.raises(KeyboardInterrupt):
            kernel.run()
        assert kernel.current is kernel.host
        for task in kernel.tasks[:]:
            kernel.kill(task)
        assert not kernel.tasks


def test_idle_threads_of_the_pool_can_be_ended() -> None:
    before = threading.active_count()
    with Kernel("thread") as kernel:
        for number in range(5):
            kernel.spawn(f"t{number}", lambda: kernel.delay(1))
        kernel.run()
    drain()
    assert threading.active_count() <= before


def test_thousand_tasks_run(kernel: Kernel) -> None:
    done: list[int] = []
    for number in range(1000):
        kernel.spawn(f"t{number}", lambda number=number: (kernel.delay(1 + number % 7), done.append(number)))
    kernel.run()
    assert len(done) == 1000
    assert done[:3] == [0, 7, 14]
