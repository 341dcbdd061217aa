"""The stall watch ends a run whose clock stands still, and changes nothing else."""

from __future__ import annotations

import contextlib
import gc
import os
import shutil
import threading
import time
import weakref
from collections.abc import Callable
from pathlib import Path
from types import FunctionType

import pytest

from cfepy.rtos import Kernel, Task, cpu_time, watchdog
from cfepy.rtos.context import UNWIND_S, drain
from cfepy.rtos.cpu_time import Expenses, Spent, kept_waiting_ns
from cfepy.rtos.watchdog import StallWatch
from cfepy.status import StallError
from cfepy.units import NS_PER_S
from tests.rtos.helpers import Clocks

LIMIT_S = 0.05  # how much of the computer's time a spinning task gets here


@pytest.fixture(autouse=True)
def _looks_follow_quickly(monkeypatch: pytest.MonkeyPatch) -> None:
    """A task that spins is looked at a dozen times, and takes the CPU all the while."""
    monkeypatch.setattr(watchdog, "LOOK_AGAIN_S", 0.002)


def is_here(file: str) -> bool:
    return file == __file__


def watched(kernel: Kernel, **options: object) -> StallWatch:
    return StallWatch(kernel, LIMIT_S, is_here, **options)  # type: ignore[arg-type]


def ended(kernel: Kernel, entry: Callable[[], object], limit_s: float = LIMIT_S) -> StallError:
    """Return the error of a run in which a task never ends its work."""
    watch = watched(kernel)
    watch.limit_s = limit_s
    kernel.spawn("spinning", entry)
    watch.begin()
    try:
        with pytest.raises(StallError) as stalled:
            kernel.run(10_000_000)
        assert kernel.current is kernel.host
        kernel.shutdown()
        assert not kernel.tasks
    finally:
        watch.end()
    return stalled.value


def spin() -> None:
    while True:
        pass


def step() -> None:
    """Call a function, during which another thread may run and look."""


def spin_deep_down() -> None:
    while True:
        for _ in "1":  # of the steps so few that not all looks find this loop
            step()
        step(), step(), step(), step(), step(), step(), step(), step(), step(), step()


def test_task_that_never_gives_up_the_cpu_ends_the_run(kernel: Kernel) -> None:
    error = ended(kernel, spin)
    line = spin.__code__.co_firstlineno + 1
    assert error.summary.startswith("task spinning has not given up the CPU since 0.000000 s of virtual time, for 0.")
    assert error.place == f"test_watchdog.py:{line}"
    assert error.lines[0].endswith(f"test_watchdog.py:{line} in spin: while True:")
    with pytest.raises(StallError):
        kernel.run(20_000_000)


def test_stall_names_the_loop_and_not_the_called_function(kernel: Kernel) -> None:
    def main() -> None:
        spin_deep_down()

    error = ended(kernel, main)
    assert error.place == f"test_watchdog.py:{spin_deep_down.__code__.co_firstlineno + 1}"
    assert error.lines[1].endswith(".main: spin_deep_down()")


def test_calls_without_cost_do_not_prevent_a_stall(kernel: Kernel) -> None:
    def poll() -> None:
        while True:
            kernel.charge(0)

    assert "has not given up the CPU" in ended(kernel, poll).summary


def test_tasks_that_keep_each_other_running_are_a_stall(kernel: Kernel) -> None:
    def toss() -> None:
        while True:
            kernel.yield_cpu()

    kernel.spawn("other", toss)
    assert ended(kernel, toss).summary.startswith("tasks other, spinning have kept each other going")


class SlowToLeave:
    """A mutex that the kernel takes from a task which has ended, for longer than a watch waits between two blows."""

    stays_locked = False

    def abandon(self, task: Task) -> None:
        until = time.monotonic() + 3 * UNWIND_S
        while time.monotonic() < until:
            pass


def test_stall_does_not_interrupt_the_kernel_while_it_ends_a_task(kernel: Kernel) -> None:
    def main() -> None:
        kernel.current.held.append(SlowToLeave())  # type: ignore[arg-type]  # it stands for a mutex
        spin()

    assert "has not given up the CPU" in ended(kernel, main).summary


def test_task_that_catches_everything_is_ended(kernel: Kernel) -> None:
    def stubborn() -> None:
        number = 0
        while True:
            try:
                for _ in range(50):
                    number += 1
            except BaseException:
                number = 0

    assert "stubborn" in ended(kernel, stubborn).lines[0]


def test_finalizer_run_by_the_garbage_collector_is_ended(kernel: Kernel, capsys: pytest.CaptureFixture[str]) -> None:
    class Spinning:
        def __init__(self) -> None:
            self.me = self

        def __del__(self) -> None:
            while True:
                pass

    def litter() -> None:
        Spinning()
        kernel.delay(20_000_000_000)

    watch = watched(kernel)
    kernel.spawn("litterer", litter)
    watch.begin()
    with pytest.raises(StallError, match="a finalizer has not finished since 10") as stalled:
        kernel.run(30_000_000_000)
    watch.end()
    assert "__del__" in stalled.value.lines[0]
    assert capsys.readouterr().err == ""


def test_finalizer_in_a_task_is_ended(kernel: Kernel) -> None:
    class Spinning:
        def __del__(self) -> None:
            while True:
                pass

    def drop() -> None:
        Spinning()
        kernel.delay(1)

    assert "__del__" in ended(kernel, drop).lines[0]


def test_task_that_does_not_end_is_forced_to(kernel: Kernel) -> None:
    def clings() -> None:
        try:
            kernel.delay(1_000_000_000)
        finally:
            spin()

    watch = watched(kernel)
    kernel.spawn("clinging", clings)
    watch.begin()
    kernel.run(10)
    assert kernel.broken is None
    kernel.shutdown()
    watch.end()
    assert isinstance(kernel.broken, StallError)
    assert "spin" in kernel.broken.lines[0]


@pytest.fixture
def soon(monkeypatch: pytest.MonkeyPatch) -> None:
    """A wish is given less time than it is for a user."""
    for name, value in (("LOOK_S", 0.05), ("SOON_S", 0.01), ("GRACE_S", 0.12), ("SPUN_S", 0.06)):
        monkeypatch.setattr(watchdog, name, value)


@pytest.mark.usefixtures("soon")
def test_request_ends_tasks_with_and_without_calls(make_kernel: Callable[[], Kernel]) -> None:
    def poll(kernel: Kernel) -> None:
        while True:
            kernel.charge(1)

    for entry, error in ((lambda kernel: spin(), StallError), (poll, KeyboardInterrupt)):
        with make_kernel() as kernel:
            watch = watched(kernel)
            watch.limit_s = 0
            watch.wanted = lambda: True
            kernel.spawn("busy", lambda kernel=kernel, entry=entry: entry(kernel))
            watch.begin()
            with pytest.raises(error):
                kernel.run()
            watch.end()


@pytest.mark.usefixtures("soon")
def test_request_is_timed_from_when_it_is_seen(make_kernel: Callable[[], Kernel]) -> None:
    """Computation before the request does not count. Only afterwards, a task that spins is reported."""
    spins = threading.Event()
    clock, seen = [0.0], [False]

    def spent() -> Spent:
        clock[0] += 0.005 if seen[0] else 0.1  # the look that sees the wish comes long after the one before it
        seen[0] = spins.is_set()
        return Spent(clock[0], clock[0], 0.0)

    def moves_on_and_spins(kernel: Kernel) -> None:
        while not clock[0]:
            threading.Event().wait(0.001)
        kernel.delay(1)  # so that this clock stands only from here on
        spins.set()
        spin()

    with make_kernel() as kernel:
        watch = watched(kernel)
        watch.limit_s, watch.spent, watch.wanted = 0, spent, spins.is_set
        kernel.spawn("busy", lambda: moves_on_and_spins(kernel))
        watch.begin()
        with pytest.raises(StallError):
            kernel.run()
        watch.end()


@pytest.mark.usefixtures("soon")
def test_request_waits_while_other_programs_use_the_cpu(
    make_kernel: Callable[[], Kernel], monkeypatch: pytest.MonkeyPatch
) -> None:
    for ready, used, broken in ((1.0, 0.0, False), (0.3, 0.7, True), (0.0, 0.0, True)):
        clocks = Clocks(monkeypatch, used, ready)
        with make_kernel() as kernel:
            watch = watched(kernel)
            watch.limit_s, watch.wanted, watch.spent = 0, lambda: True, clocks
            kernel.spawn("computing", clocks.wait_for_looks)
            watch.begin()
            with pytest.raises((StallError, KeyboardInterrupt)) if broken else contextlib.nullcontext():
                kernel.run(10)
            assert (kernel.broken is not None) is broken
            watch.end()


@pytest.mark.usefixtures("soon")
@pytest.mark.parametrize("used", [0.2, 0.9])
def test_only_cpu_time_counts_against_the_limit(
    make_kernel: Callable[[], Kernel], monkeypatch: pytest.MonkeyPatch, used: float
) -> None:
    """While other programs have the CPU for most of the time, a run may take longer by the clock on the wall."""
    clocks = Clocks(monkeypatch, used, 1.0 - used)
    wall_s = list[float]()
    with make_kernel() as kernel:
        watch = watched(kernel)
        watch.limit_s, watch.spent = 0.5, clocks
        monkeypatch.setattr(watch, "_break_off", lambda *_: wall_s.append(clocks().wall_s))

        def compute() -> None:
            while not wall_s:
                threading.Event().wait(0.001)

        kernel.spawn("computing", compute)
        watch.begin()
        kernel.run(10)
        watch.end()
    assert 0.5 / used <= wall_s[0] / 2 < 0.5 / used + 0.2  # these clocks also advance while a look lasts


def test_other_threads_of_the_process_do_not_count() -> None:
    before = Spent(0.0, 0.0, 0.0, {1: (1.0, 0.0), 2: (5.0, 0.5)})
    now = Spent(1.0, 9.0, 9.0, {1: (1.25, 0.5), 2: (9.0, 1.0), 3: (0.5, 0.0)})
    assert now.since(before, {1}) == (0.25, 0.5)
    assert now.since(before, {1, 3, 4}) == (0.25, 0.5)  # 3 is new, or could not be read before
    assert Spent(1.0, 9.0, 8.0).since(before, {1}) == (9.0, 8.0)


def test_watch_counts_the_threads_of_the_runs_tasks(kernel: Kernel) -> None:
    watch = watched(kernel)
    watch.limit_s = 1000
    seen = set[int]()

    def task() -> None:
        seen.add(threading.get_native_id())
        kernel.delay(10)

    kernel.spawn("first", task)
    kernel.spawn("second", task)
    watch.begin()
    kernel.run(1)
    assert seen <= watch._threads()
    watch.end()


def test_task_that_waits_for_the_host_is_reported_once(make_kernel: Callable[[], Kernel]) -> None:
    reader, writer = os.pipe()
    told: list[str] = []

    def tell(text: str) -> None:
        told.append(text)
        threading.Timer(2 * LIMIT_S, lambda: os.write(writer, b"x")).start()

    with make_kernel() as kernel:
        watch = watched(kernel, tell=tell)
        watch.spent = lambda: Spent(time.monotonic(), 0.0, 0.0)  # other threads of this process may be busy
        kernel.spawn("asking", lambda: os.read(reader, 1))
        watch.begin()
        kernel.run(10)
        watch.end()
    os.close(reader)
    os.close(writer)
    assert len(told) == 1
    assert told[0].startswith("cfepy: task asking has been waiting for something outside the simulation since 0.0000")


@pytest.mark.usefixtures("soon")
def test_task_that_cannot_be_interrupted_is_abandoned() -> None:
    reader, writer = os.pipe()
    watch_limit_s = 0
    with Kernel("thread") as kernel:
        watch = watched(kernel)
        watch.limit_s, watch.wanted = watch_limit_s, lambda: True
        stuck = kernel.spawn("stuck", lambda: os.read(reader, 1))
        kernel.spawn("late", lambda: kernel.delay(1))
        watch.begin()
        with pytest.raises(StallError, match="stuck has been waiting for something outside"):
            kernel.run()
        assert kernel.stuck == [stuck]
        kernel.shutdown()
        watch.end()
    os.write(writer, b"x")
    while stuck.carrier.alive:  # the thread ends without passing on the CPU
        threading.Event().wait(0.001)
    os.close(reader)
    os.close(writer)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system cannot fork a process")
def test_watch_restarts_in_a_forked_process(make_kernel: Callable[[], Kernel]) -> None:
    with make_kernel() as kernel:
        watch = watched(kernel)
        kernel.spawn("sleeper", lambda: kernel.delay(1000))
        watch.begin()
        kernel.run(1)
        child = os.fork()
        if not child:
            watch.begin()
            os._exit(watch._thread is None or not watch._thread.is_alive())
        assert os.waitpid(child, 0)[1] == 0
        watch.end()


@pytest.mark.parametrize("pieces", [1, 50])
def test_watch_of_many_pieces_has_one_thread(make_kernel: type[Kernel], pieces: int) -> None:
    before = threading.active_count()
    with make_kernel() as kernel:
        watch = StallWatch(kernel)
        kernel.spawn("sleeper", lambda: kernel.delay(1000))
        for piece in range(pieces):
            watch.begin()
            kernel.run(piece)
        assert threading.active_count() == before + 1
        watch.end()
    assert threading.active_count() == before


@pytest.mark.parametrize("waits", [False, True])
def test_run_that_continues_during_the_check_is_not_ended(
    make_kernel: Callable[[], Kernel], monkeypatch: pytest.MonkeyPatch, waits: bool
) -> None:
    """To look takes longer than many a piece of a run, so another piece may have begun."""
    share = 0.0 if waits else 1.0
    looked_at, goes_on, judged = threading.Event(), threading.Event(), threading.Event()
    told: list[str] = []

    def until(event: threading.Event) -> None:
        while not event.wait(0.001):
            pass

    def late() -> None:
        until(looked_at)
        kernel.delay(1)
        goes_on.set()
        until(judged)

    with make_kernel() as kernel:
        watch = watched(kernel, tell=told.append)
        hold = watch._hold_against_limit
        watch.spent = Clocks(monkeypatch, share, 0.0)

        def looks(stand: object) -> list[tuple[object, ...]]:
            looked_at.set()
            until(goes_on)
            return []

        def held(stand: object) -> None:
            hold(stand)  # type: ignore[arg-type]
            if goes_on.is_set():
                judged.set()

        monkeypatch.setattr(watch, "_looks", looks)
        monkeypatch.setattr(watch, "_hold_against_limit", held)
        kernel.spawn("late", late)
        watch.begin()
        kernel.run(10)
        assert kernel.broken is None
        watch.end()
    assert told == []


def test_limit_of_0_disables_the_watch(kernel: Kernel) -> None:
    watch = watched(kernel)
    watch.limit_s = 0
    done = threading.Event()
    threading.Timer(3 * LIMIT_S, done.set).start()

    def compute() -> None:
        while not done.is_set():
            pass

    kernel.spawn("long", compute)
    watch.begin()
    kernel.run(10)
    watch.end()
    assert kernel.broken is None


def test_watch_does_not_hold_an_ended_task() -> None:
    """A task holds its application and with it a whole processor, which a reset is to leave behind."""
    with Kernel(context="thread") as kernel:
        watch = StallWatch(kernel)
        looked = threading.Event()

        def body() -> None:
            watch._look(0.0, False, 0.0)
            looked.set()

        application = type("Application", (), {})()
        held = weakref.ref(application)
        kernel.spawn("task", body, owner=application)
        del application
        kernel.run(100)
        assert looked.is_set()
        assert watch._stand is not None
        kernel.unwind()
        drain()
        gc.collect()
        assert held() is None


def test_time_used_by_other_programs_counts(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    told = {
        "1": "5 2000000000 7\n",
        "2": "5 500000000 7\n",
        str(threading.get_native_id()): "0 9000000000 1\n",
        "3": "",
    }
    for thread, text in told.items():
        (tmp_path / thread).mkdir()
        (tmp_path / thread / "schedstat").write_text(text, encoding="utf-8")
    (tmp_path / "4").mkdir()  # a thread that has just ended
    monkeypatch.setattr(cpu_time, "THREADS", str(tmp_path))
    monkeypatch.setattr(time, "process_time", lambda: 1.5)
    monkeypatch.setattr(time, "thread_time", lambda: 0.5)
    monkeypatch.setattr(time, "monotonic", lambda: 9.0)
    by_thread = {1: (5e-9, 2.0), 2: (5e-9, 0.5)}
    assert Expenses()() == Spent(wall_s=9.0, used_s=1.0, ready_s=2.5, by_thread=by_thread)
    monkeypatch.setattr(cpu_time, "THREADS", str(tmp_path / "none"))
    assert Expenses()() == Spent(wall_s=9.0, used_s=1.0, ready_s=0.0)


def test_time_of_the_check_itself_is_not_counted() -> None:
    """On a computer so slow that looking takes a tenth of its time, a task that waits seemed to compute."""
    spent = Expenses()
    before, begun_s = spent().used_s, time.thread_time()
    while time.thread_time() < begun_s + 0.2:
        pass
    assert spent().used_s - before < 0.1


def test_time_counted_for_an_ended_thread_is_kept(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cpu_time, "THREADS", str(tmp_path))

    def tell(thread: str, ready_s: int) -> None:
        (tmp_path / thread).mkdir(exist_ok=True)
        (tmp_path / thread / "schedstat").write_text(f"0 {ready_s * NS_PER_S} 7\n", encoding="utf-8")

    spent = Expenses()
    tell("1", 2)
    tell("2", 5)
    assert spent().ready_s == 7
    (tmp_path / "2" / "schedstat").write_text("", encoding="utf-8")  # cannot be read just now
    tell("1", 3)
    assert spent().ready_s == 8
    tell("2", 6)
    assert spent().ready_s == 9
    shutil.rmtree(tmp_path / "2")
    assert spent().ready_s == 9
    tell("2", 1)  # another thread with its number
    assert spent().ready_s == 10
    tell("1", 1)  # the same between two looks
    assert spent().ready_s == 11
    monkeypatch.setattr(cpu_time, "THREADS", str(tmp_path / "none"))
    assert spent().ready_s == 11


def test_time_that_a_process_was_kept_waiting_is_read() -> None:
    assert kept_waiting_ns(os.getpid()) >= 0
    assert kept_waiting_ns(2**30) == 0


def test_new_piece_of_a_run_starts_without_observations(kernel: Kernel) -> None:
    watch = watched(kernel)
    watch.limit_s = 1000  # so that its thread looks seldom
    kernel.spawn("task", lambda: watch._look(0.0, False, 0.0))
    kernel.run(1)
    assert watch._stand is not None
    watch.begin()
    assert watch._stand is None
    watch.end()


def test_code_without_line_numbers_is_reported_with_the_line_of_its_function() -> None:
    def spin() -> None:
        while True:
            pass

    lineless = FunctionType(spin.__code__.replace(co_linetable=b""), {})
    stalled = ended(Kernel("thread"), lineless)
    assert stalled.place == f"test_watchdog.py:{spin.__code__.co_firstlineno}"


def test_process_times_are_read_only_when_the_clock_stands_still(kernel: Kernel) -> None:
    """It takes time for each thread of the process, and each of many missions asks."""
    asked = list[int]()

    def spent() -> Spent:
        asked.append(kernel.now)
        return Spent(0.0, 0.0, 0.0)

    def look() -> None:
        watch._look_again(0.1)

    def task() -> None:
        for number in range(20):
            look()
            kernel.delay(10)
            if number == 10:
                look()
                look()

    watch = watched(kernel)
    watch.spent = spent
    look()
    kernel.spawn("task", task)
    kernel.run()
    look()
    assert set(asked) == {110}
