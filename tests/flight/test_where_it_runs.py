"""Missions fly the same in every environment of a program: threads, asyncio, forked and spawned processes.

Code that could hang runs in a separate process, or on a daemon thread, so that a test fails instead.
"""

from __future__ import annotations

import asyncio
import multiprocessing
import os
import pickle
import select
import signal
import threading
from collections.abc import Callable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from typing import Any

import pytest

import cfepy

pytest.importorskip("greenlet")

# Python 3.12 warns of other threads in a process that forks: these tests use them on purpose
pytestmark = pytest.mark.filterwarnings("ignore:.*multi-threaded, use of fork:DeprecationWarning")

LONGEST_S = 60.0  # limit for a test that hangs; no result depends on it
SECONDS = 0.8  # from the boot
TASKS = ("thread", "greenlet")
NODE = """
import rospy
from std_msgs.msg import Int32

rospy.init_node("counter")
publisher = rospy.Publisher("count", Int32, queue_size=10)
rospy.Subscriber("count", Int32, lambda message: None)
for number in range(1000):
    publisher.publish(number)
    rospy.sleep(0.01)
"""

each_kind_of_task = pytest.mark.parametrize("tasks", TASKS)
needs_fork = pytest.mark.skipif(not hasattr(os, "fork"), reason="this system has no fork")


def digest(mission: str, tasks: str) -> str:
    """Return the digest of a small run, in 32 digits."""
    return cfepy.run(mission, seconds=SECONDS, seed=7, tasks=tasks).trace


@pytest.fixture(scope="module")
def counter(tmp_path_factory: pytest.TempPathFactory) -> str:
    """Return a mission of one node that sends to itself."""
    folder = tmp_path_factory.mktemp("where")
    (folder / "counter.py").write_text(NODE, encoding="utf-8")
    (folder / "startup.scr").write_text(
        "CFE_APP, counter.py, __main__, COUNTER, 100, 65536, 0x0, 0;\n!\n", encoding="utf-8"
    )
    return str(folder)


@pytest.fixture(scope="module")
def usual(counter: str) -> str:
    """Return the digest that all of them must have."""
    return digest(counter, "thread")


def in_thread(work: Callable[..., Any], *args: Any, **options: Any) -> Future[Any]:
    """Begin something in another thread, which ends with the process at the latest."""
    result: Future[Any] = Future()

    def run() -> None:
        try:
            result.set_result(work(*args, **options))
        except BaseException as error:
            result.set_exception(error)

    threading.Thread(target=run, daemon=True).start()
    return result


def in_fork(work: Callable[..., Any], *args: Any) -> Any:
    """Return a function's result in a forked process, or raise its exception. The process is killed if it hangs."""
    reader, writer = os.pipe()
    child = os.fork()
    if not child:
        answer: Any = None
        try:
            answer = work(*args)
        except BaseException as error:
            answer = error
        finally:
            os.write(writer, pickle.dumps(answer))
            os._exit(0)
    os.close(writer)
    try:
        if not select.select([reader], [], [], LONGEST_S)[0]:
            os.kill(child, signal.SIGKILL)
            pytest.fail("the forked process hangs")
        with open(reader, "rb") as answers:
            return pickle.load(answers)
    finally:
        os.waitpid(child, 0)


@contextmanager
def flying(mission: str, tasks: str) -> Iterator[cfepy.Flight]:
    """A mission that has begun to fly."""
    with cfepy.boot(mission, seed=7, tasks=tasks) as flight:
        flight.run_for(SECONDS / 2)
        yield flight


# -- threads -----------------------------------------------------------------------------------------------------------


@each_kind_of_task
def test_trace_is_the_same_in_the_main_thread_another_thread_and_two_at_once(
    tasks: str, counter: str, usual: str
) -> None:
    assert digest(counter, tasks) == usual
    runs = [in_thread(digest, counter, tasks) for _ in range(2)]
    assert [run.result(LONGEST_S) for run in runs] == [usual] * 2


def test_mission_on_threads_continues_in_another_thread(counter: str, usual: str) -> None:
    def go_on() -> str:
        flight.run_until(SECONDS)
        return flight.trace

    with flying(counter, "thread") as flight:
        assert in_thread(go_on).result(LONGEST_S) == usual


def test_mission_begun_in_another_thread_continues_in_a_third(counter: str, usual: str) -> None:
    """As with asyncio.to_thread, which takes any thread of a pool."""
    flight = in_thread(cfepy.boot, counter, seed=7).result(LONGEST_S)
    with flight:
        in_thread(flight.run_until, SECONDS).result(LONGEST_S)
        assert flight.trace == usual
    run = in_thread(lambda: cfepy.run(counter, seconds=0.1)).result(LONGEST_S)
    assert str(run.results.task_kind) == "thread tasks (begun outside of Python's main thread)"


def test_greenlets_in_another_thread_are_refused(counter: str) -> None:
    with flying(counter, "greenlet") as flight:
        for touch in (lambda: flight.run_for(0.1), flight.close, lambda: flight.trace):
            with pytest.raises(RuntimeError, match="greenlets of the thread that booted it"):
                in_thread(touch).result(LONGEST_S)
        flight.run_for(0.1)  # nothing has happened to it


# -- asyncio -----------------------------------------------------------------------------------------------------------


@each_kind_of_task
def test_trace_is_the_same_inside_asyncio(tasks: str, counter: str, usual: str) -> None:
    async def fly() -> list[str]:
        first = digest(counter, tasks)  # in the loop itself, which stands still meanwhile
        two = await asyncio.gather(*(asyncio.to_thread(digest, counter, tasks) for _ in range(2)))
        return [first, *two]

    assert asyncio.run(fly()) == [usual] * 3


# -- processes ---------------------------------------------------------------------------------------------------------


@needs_fork
@each_kind_of_task
def test_trace_is_the_same_after_a_fork(tasks: str, counter: str, usual: str) -> None:
    digest(counter, tasks)  # so that there are threads that the child does not have
    assert in_fork(digest, counter, tasks) == usual


@pytest.mark.slow
@needs_fork
@each_kind_of_task
def test_trace_is_the_same_after_a_fork_during_another_mission(tasks: str, counter: str, usual: str) -> None:
    """At the moment of the fork, the other thread may be anywhere in its run."""
    over = threading.Event()

    def fly_on() -> None:
        while not over.is_set():
            digest(counter, tasks)

    other = in_thread(fly_on)
    try:
        assert [in_fork(digest, counter, tasks) for _ in range(3)] == [usual] * 3
    finally:
        over.set()
        other.result(LONGEST_S)


@needs_fork
def test_mission_on_threads_is_refused_in_a_forked_process(counter: str, usual: str) -> None:
    with flying(counter, "thread") as flight:
        for touch in (lambda: flight.run_for(0.1), flight.close, lambda: flight.trace):
            error = in_fork(touch)
            assert isinstance(error, RuntimeError)
            assert "threads of another process" in str(error)
        assert in_fork(digest, counter, "thread") == usual  # another one can fly beside it
        flight.run_until(SECONDS)
        assert flight.trace == usual


@needs_fork
def test_mission_on_greenlets_continues_in_a_forked_process(counter: str, usual: str) -> None:
    def go_on() -> str:
        flight.run_until(SECONDS)
        return flight.trace

    with flying(counter, "greenlet") as flight:
        assert in_fork(go_on) == usual
        assert go_on() == usual


@pytest.mark.slow
@each_kind_of_task
@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
def test_trace_is_the_same_in_a_pool_of_processes(method: str, tasks: str, counter: str, usual: str) -> None:
    context = multiprocessing.get_context(method)
    with context.Pool(2) as pool:  # which ends by killing them
        results = pool.starmap_async(digest, [(counter, tasks)] * 4)
        assert results.get(LONGEST_S) == [usual] * 4


@pytest.mark.slow
def test_trace_is_the_same_in_a_pool_of_threads(counter: str, usual: str) -> None:
    with ThreadPoolExecutor(8) as pool:
        runs = [pool.submit(digest, counter, TASKS[number % 2]) for number in range(40)]
        assert {run.result(LONGEST_S) for run in runs} == {usual}
