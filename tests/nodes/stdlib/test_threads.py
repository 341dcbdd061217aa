"""Threads, locks and queues of the standard library on virtual time."""

from __future__ import annotations

from textwrap import dedent

import pytest

from cfepy.nodes import Universe
from cfepy.rtos import DeadlockError, Kernel
from cfepy.trace import Trace
from tests.own_paths import own_files

SECOND = 1_000_000_000

WORKERS = """
    import queue, random, threading, time
    from concurrent.futures import ThreadPoolExecutor

    items = queue.Queue(maxsize=5)
    done = threading.Event()
    lock = threading.Lock()
    log = []

    def produce(number):
        count = 0
        while not done.is_set():
            items.put((number, count, random.random()))
            count += 1
            time.sleep(0.1)

    def consume():
        while True:
            try:
                item = items.get(timeout=0.05)
            except queue.Empty:
                if done.is_set():
                    return
                continue
            with lock:
                log.append((time.monotonic(), threading.current_thread().name, item))
            items.task_done()

    def square(x):
        time.sleep(0.25)
        return x * x

    threads = [threading.Thread(target=produce, args=(n,), daemon=True) for n in range(3)]
    threads += [threading.Thread(target=consume, name=f"consumer {n}") for n in range(2)]
    for thread in threads:
        thread.start()
    timer = threading.Timer(3.0, lambda: log.append(("timer", time.monotonic())))
    timer.start()
    with ThreadPoolExecutor(max_workers=3) as pool:
        squares = list(pool.map(square, range(7)))
    pool_time = time.monotonic()
    time.sleep(5)
    done.set()
"""


def test_queue_timer_and_pool(run):
    program = run(WORKERS, call_cost_ns=0)
    log = program.global_("log")
    assert program.global_("squares") == [0, 1, 4, 9, 16, 25, 36]
    assert program.global_("pool_time") == 0.75
    assert ("timer", 3.0) in log
    assert len(log) == 3 * 58 + 1
    assert program.universe.exit_status == 0
    assert program.universe.tasks == ()


def test_trace_is_the_same_on_threads_and_greenlets(tmp_path):
    script = tmp_path / "workers.py"
    script.write_text(dedent(WORKERS), encoding="utf-8")
    seen = set()
    for context in ("thread", "greenlet", "thread"):
        with Kernel(context=context, trace=Trace()) as kernel:
            universe = Universe(kernel, name="workers", script=script, seed=4)
            universe.spawn()
            kernel.run()
            seen.add((kernel.trace.digest(), repr(universe.importer.modules["__main__"].log)))
    assert len(seen) == 1


@pytest.mark.parametrize(
    "body",
    [
        "lock = threading.Lock(); lock.acquire(); assert not lock.acquire(timeout=0.5); assert now() == 0.5",
        "lock = threading.Lock(); assert lock.acquire(False); assert not lock.acquire(False); lock.release()",
        "lock = threading.RLock(); lock.acquire(); assert lock.acquire(timeout=1); lock.release(); lock.release()",
        "event = threading.Event(); assert not event.wait(2); assert now() == 2; event.set(); assert event.wait(1)",
        "s = threading.Semaphore(2); s.acquire(); s.acquire(); assert not s.acquire(timeout=1); assert now() == 1",
        "c = threading.Condition()\nwith c: assert not c.wait(0.25)\nassert now() == 0.25",
        "c = threading.Condition()\nwith c: assert not c.wait_for(lambda: False, 0.25)\nassert now() >= 0.25",
        "b = threading.Barrier(2); t = spawn(lambda: (time.sleep(1), b.wait())); b.wait(); assert now() == 1; t.join()",
        "q = queue.SimpleQueue(); spawn(lambda: (time.sleep(1), q.put(7))); assert q.get() == 7; assert now() == 1",
        "q = queue.PriorityQueue(); q.put(3); q.put(1); assert q.get() == 1",
        "s = sched.scheduler(); s.enter(2, 1, got.append, ('x',)); s.run(); assert got == ['x']; assert now() == 2",
        "t = spawn(lambda: time.sleep(3)); t.join(1); assert t.is_alive(); t.join(); assert now() == 3",
        "t = spawn(lambda: got.append(threading.current_thread())); t.join(); assert got == [t]",
        "assert threading.main_thread() is threading.current_thread(); assert threading.active_count() == 1",
        "_thread.start_new_thread(got.append, (5,)); time.sleep(1); assert got == [5]",
        "t = threading.Timer(1, got.append, (1,)); t.start(); t.cancel(); time.sleep(2); assert got == []",
    ],
)
def test_primitives(run, body):
    helper = """
import _thread, queue, sched, threading, time
got = []
def now():
    return time.monotonic()
def spawn(function):
    thread = threading.Thread(target=function)
    thread.start()
    return thread
"""
    program = run(helper + body, call_cost_ns=0)
    assert program.text == ""
    assert program.universe.exit_status == 0


@pytest.mark.parametrize(
    ("body", "error"),
    [
        ("threading.Lock().release()", "RuntimeError: release unlocked lock"),
        ("threading.RLock().release()", "RuntimeError: cannot release un-acquired lock"),
        ("lock = threading.Lock(); lock.acquire(False, 1)", "ValueError: can't specify a timeout"),
        ("lock = threading.Lock(); lock.acquire(timeout=-2)", "ValueError: timeout value must be"),
    ],
)
def test_misuse_of_locks(run, body, error):
    assert error in run(f"import threading; {body}").text


def test_waiters_of_a_lock_are_served_in_order(run):
    program = run("""
        import threading, time
        lock, log = threading.Lock(), []
        def use(number):
            with lock:
                time.sleep(1)
                log.append(number)
        for number in range(5):
            threading.Thread(target=use, args=(number,)).start()
    """)
    assert program.global_("log") == [0, 1, 2, 3, 4]


def test_local_is_separate_for_each_thread_and_calls_init_in_each(run):
    program = run("""
        import threading, time
        class Own(threading.local):
            made = 0
            def __init__(self, start):
                self.value = start
                Own.made += 1
        own, seen = Own(10), []
        def work(number):
            own.value += number
            time.sleep(1)
            seen.append(own.value)
        threads = [threading.Thread(target=work, args=(n,)) for n in range(3)]
        for thread in threads: thread.start()
        for thread in threads: thread.join()
        assert own.value == 10 and Own.made == 4 and not hasattr(threading.local(), "value")
    """)
    assert program.text == ""
    assert program.global_("seen") == [10, 11, 12]


def test_error_in_a_thread_is_shown_and_the_node_continues(run):
    program = run("""
        import threading, time
        def fail():
            time.sleep(-1)
        threading.Thread(target=fail, name="worker").start()
        time.sleep(1)
        print("alive")
    """)
    assert program.lines[0] == "Exception in thread worker:"
    assert program.lines[-2:] == ["ValueError: sleep length must be non-negative", "alive"]
    assert "in fail" in program.text
    assert own_files(program.text) == []
    assert [type(error) for error in program.universe.thread_errors] == [ValueError]
    assert program.universe.exit_status == 0


def test_polling_loops_make_progress(run):
    program = run("""
        import queue, threading, time
        event, items = threading.Event(), queue.Queue()
        threading.Timer(0.01, event.set).start()
        while not event.is_set():
            pass
        threading.Timer(0.01, items.put, (1,)).start()
        while items.empty():
            pass
        end = time.time() + 0.01
        while time.time() < end:
            pass
        thread = threading.Timer(0.01, print, ("done",)); thread.start()
        while thread.is_alive():
            pass
        while threading.active_count() > 1:
            time.sleep(0)
    """)
    assert program.text == "done"


def test_killing_a_node_unwinds_all_its_threads(start):
    program = start("""
        import threading
        log, never = [], threading.Event()
        lock = threading.Lock()
        def wait(number):
            try:
                with lock:
                    never.wait()
            finally:
                log.append(number)
        for number in range(3):
            threading.Thread(target=wait, args=(number,)).start()
        try:
            never.wait()
        finally:
            log.append("main")
    """)
    program.kernel.run(SECOND)
    assert program.universe.main_task is not None
    program.kernel.kill(program.universe.main_task)
    assert sorted(map(str, program.global_("log"))) == ["0", "1", "2", "main"]
    assert program.universe.tasks == ()
    assert not program.kernel.tasks
    assert program.text == ""


def test_thread_that_never_ran_ends_with_the_program(run):
    program = run("""
        import _thread
        _thread.start_new_thread(print, ("too late",))
    """)
    assert program.text == ""
    assert program.universe.exit_status == 0
    assert not program.kernel.tasks


def test_error_of_a_thread_that_unwinds_is_not_shown(run):
    program = run("""
        import _thread, threading, time
        never = threading.Event()
        def work():
            try:
                never.wait()
            except:
                raise ValueError("unwound")
        threading.Thread(target=work, daemon=True).start()
        _thread.start_new_thread(work, ())
        time.sleep(0.1)
    """)
    assert program.text == ""
    assert program.universe.thread_errors == []
    assert program.universe.exit_status == 0


def test_threads_print_nothing_after_exit_by_another_thread(run):
    program = run("""
        import os, sys, threading, time, traceback
        never = threading.Event()
        def work():
            try:
                never.wait()
            except:
                traceback.print_exc()
        threading.Thread(target=work).start()
        time.sleep(0.1)
        print("all is lost", file=sys.stderr, end="")
        os._exit(3)
    """)
    assert program.text == "all is lost"
    assert program.universe.exit_status == 3
    assert program.universe.last_words == "all is lost"


@pytest.mark.parametrize("first", [0, 1, 2])
def test_tasks_of_a_node_can_be_ended_in_any_order(start, first):
    program = start("""
        import threading, time
        lock, log = threading.Lock(), []
        def work():
            while True:
                with lock:
                    time.sleep(0.1)
        for _ in range(2):
            threading.Thread(target=work).start()
        try:
            while True:
                time.sleep(1)
        finally:
            log.append("end")
    """)
    program.kernel.run(SECOND)
    tasks = program.universe.tasks
    assert len(tasks) == 3

    def end():
        for number in range(3):
            program.kernel.kill(tasks[(first + number) % 3])

    program.kernel.spawn("owner", end, 10)
    program.kernel.run(2 * SECOND)
    assert program.global_("log") == ["end"]
    assert not program.kernel.tasks


def test_lock_handed_to_an_ended_task_goes_to_the_next(start):
    program = start("""
        import threading, time
        lock, log = threading.Lock(), []
        lock.acquire()
        def use(number):
            with lock:
                log.append(number)
        for number in range(2):
            threading.Thread(target=use, args=(number,)).start()
        time.sleep(5)
    """)
    program.kernel.run(SECOND)
    first = program.universe.tasks[1]

    def hand_over_and_end():
        program.global_("lock").release()
        program.kernel.kill(first)

    program.kernel.spawn("owner", hand_over_and_end, 10)
    program.kernel.run()
    assert program.global_("log") == [1]
    assert not program.global_("lock").locked()


def test_deadlock_is_reported_with_its_locks(start):
    program = start("""
        import threading, time
        a, b = threading.RLock(), threading.RLock()
        def take(first, second):
            with first:
                time.sleep(1)
                with second:
                    pass
        for locks in ((a, b), (b, a)):
            threading.Thread(target=take, args=locks).start()
    """)
    with pytest.raises(DeadlockError, match=r"lock \d+ of node"):
        program.kernel.run()


def test_threads_start_through_the_owners_hook(start):
    names = []

    def own(name, entry, priority):
        names.append((name, priority))
        return program.kernel.spawn(name, entry, priority, owner="app")

    program = start(
        "import threading\nfor _ in range(2): threading.Thread(target=print).start()",
        on_thread_start=own,
        priority=70,
    )
    program.kernel.run()
    assert names == [("node.1", 70), ("node.2", 70)]


def test_imports_wait_for_another_thread_that_imports(run, tmp_path):
    (tmp_path / "slow.py").write_text("import time\ntime.sleep(1)\nvalue = 3\n", encoding="utf-8")
    program = run(
        """
        import threading, time
        seen = []
        def use():
            import slow
            seen.append((slow.value, time.monotonic()))
        for _ in range(2):
            threading.Thread(target=use).start()
    """,
        call_cost_ns=0,
    )
    assert program.text == ""
    assert program.global_("seen") == [(3, 1.0), (3, 1.0)]


def test_hashes_of_futures_and_tasks_show_no_addresses(run):
    program = run("""
        import asyncio, concurrent.futures
        def counts_up(things):
            return [hash(thing) - hash(things[0]) for thing in things] == list(range(len(things)))
        with concurrent.futures.ThreadPoolExecutor(2) as pool:
            futures = [pool.submit(int) for _ in range(40)]
            concurrent.futures.wait(futures)
            print(counts_up(futures))
        async def main():
            tasks = [asyncio.create_task(asyncio.sleep(0)) for _ in range(40)]
            await asyncio.wait(tasks)
            print(counts_up(tasks))
        asyncio.run(main())
    """)
    assert program.lines == ["True", "True"]
