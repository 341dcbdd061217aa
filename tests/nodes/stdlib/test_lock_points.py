"""Preemptions of threads of a node that use locks: all outcomes are reached, and few schedules are wasted."""

from __future__ import annotations

import textwrap
from pathlib import Path

import pytest

from cfepy.extra.exploration.search import DepthFirst
from cfepy.nodes import Universe
from cfepy.rtos import DeadlockError, NotingPolicy, Policy
from cfepy.schedules import make_kernel
from cfepy.trace import Trace

DEADLOCK = "deadlock"
MOST = 400  # schedules

START = """
import queue, threading
from concurrent.futures import ThreadPoolExecutor
out = []
def run(*functions):
    threads = [threading.Thread(target=each) for each in functions]
    for each in threads: each.start()
    for each in threads: each.join()
"""
PROGRAMS = {
    "start": (
        """
        thread = threading.Thread(target=lambda: out.append("b"))
        out.append("a")
        thread.start()
        out.append("c")
        thread.join()
        """,
        {"abc", "acb"},
    ),
    "alive": (
        """
        thread = threading.Thread(target=lambda: None)
        thread.start()
        out.append("yes" if thread.is_alive() else "no")
        """,
        {"yes", "no"},
    ),
    "active": (
        """
        threading.Thread(target=lambda: None).start()
        out.append(str(threading.active_count()) + str(len(threading.enumerate())))
        """,
        {"22", "11", "21"},
    ),
    "lock": (
        """
        lock = threading.Lock()
        def add(text):
            with lock: out.append(text)
        run(lambda: add("a"), lambda: add("b"))
        """,
        {"ab", "ba"},
    ),
    "two sections": (
        """
        lock = threading.Lock()
        def add(first, second):
            with lock: out.append(first)
            with lock: out.append(second)
        run(lambda: add("a", "b"), lambda: add("c", "d"))
        """,
        {"abcd", "acbd", "acdb", "cabd", "cadb", "cdab"},
    ),
    "lock order": (
        """
        one, other = threading.Lock(), threading.RLock()
        def take(first, second, text):
            with first:
                with second: out.append(text)
        run(lambda: take(one, other, "a"), lambda: take(other, one, "b"))
        """,
        {"ab", "ba", DEADLOCK},
    ),
    "queue": (
        """
        items = queue.Queue()
        def get(): out.append(items.get())
        run(lambda: items.put("a"), lambda: items.put("b"), get)
        out.append(items.get())
        """,
        {"ab", "ba"},
    ),
    "full queue": (
        """
        items = queue.Queue(1)
        def put(text):
            try: items.put_nowait(text)
            except queue.Full: out.append(text)
        run(lambda: put("a"), lambda: put("b"))
        """,
        {"a", "b"},
    ),
    "event": (
        """
        event = threading.Event()
        def look(): out.append(str(event.is_set()))
        def wait():
            event.wait()
            out.append("w")
        run(look, event.set, wait)
        """,
        {"Truew", "wTrue", "Falsew"},
    ),
    "cleared event": (
        """
        event = threading.Event()
        def clear():
            event.clear()
            event.wait()
        run(event.set, clear)
        out.append("woken")
        """,
        {"woken", DEADLOCK},
    ),
    "condition": (
        """
        condition = threading.Condition()
        def wait():
            with condition: condition.wait()
            out.append("w")
        def notify():
            with condition: condition.notify()
            out.append("n")
        run(wait, notify)
        """,
        {"wn", "nw", DEADLOCK},
    ),
    "semaphore": (
        """
        semaphore = threading.Semaphore(0)
        def take(text):
            semaphore.acquire()
            out.append(text)
            semaphore.release()
        run(lambda: take("a"), lambda: take("b"), semaphore.release)
        """,
        {"ab", "ba"},
    ),
    "pool": (
        """
        with ThreadPoolExecutor(2) as pool:
            for text in "ab": pool.submit(out.append, text)
        """,
        {"ab", "ba"},
    ),
    "future": (
        """
        with ThreadPoolExecutor(1) as pool:
            result = pool.submit(lambda: None)
            out.append("done" if result.done() else "not yet")
        """,
        {"done", "not yet"},
    ),
}
QUICK = ("start", "alive", "active", "future")


def flown(script: Path, policy: Policy | None = None) -> tuple[str, str]:
    """Return the content of `out`, or the deadlock at the end, and the digest of the run."""
    trace = Trace()
    with make_kernel("greenlet", trace, policy) as kernel:
        universe = Universe(kernel, name="node", script=script)
        universe.spawn()
        try:
            kernel.run()
        except DeadlockError:
            return DEADLOCK, ""
        return "".join(universe.importer.modules["__main__"].out), trace.digest()


@pytest.fixture
def script(request: pytest.FixtureRequest, tmp_path: Path) -> Path:
    """A program, in a file."""
    file = tmp_path / "node.py"
    file.write_text(START + textwrap.dedent(PROGRAMS[request.param][0]), encoding="utf-8")
    return file


@pytest.mark.parametrize(
    ("script", "name"),
    [pytest.param(name, name, id=name, marks=[] if name in QUICK else pytest.mark.slow) for name in PROGRAMS],
    indirect=["script"],
)
def test_all_outcomes_are_reached(script: Path, name: str) -> None:
    search, found = DepthFirst(2, 2), set()
    for _ in range(MOST):
        schedule = search.next()
        if schedule is None:
            break
        noted = NotingPolicy(schedule.policy())
        found.add(flown(script, noted)[0])
        search.learn(schedule, noted.widths, noted.running)
    assert found == PROGRAMS[name][1]


@pytest.mark.parametrize(("script", "name"), [(name, name) for name in PROGRAMS], indirect=["script"])
def test_explicit_default_schedule_gives_the_same_run(script: Path, name: str) -> None:
    assert flown(script, Policy()) == flown(script)


@pytest.mark.parametrize("script", ["lock"], indirect=True)
def test_internal_locks_of_the_standard_library_need_no_decisions(script: Path) -> None:
    noted = NotingPolicy()
    assert flown(script, noted)[0] == "ab"
    lines = ["a starts", "a takes", "a gives", "b starts", "b takes", "b gives", "join"]
    assert len(noted.choices) <= len(lines)
