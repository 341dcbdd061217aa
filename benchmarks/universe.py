"""The cost of a node's universe: its creation, its locks and queues against Python's own, and a threaded program."""

from __future__ import annotations

import queue
import tempfile
import threading
from collections.abc import Callable
from pathlib import Path
from time import perf_counter_ns
from typing import Any

from cfepy.nodes import Universe
from cfepy.rtos import Kernel
from cfepy.trace import Trace

_ROUNDS = 7
_CALLS = 20_000
_SECONDS = 60

_PROGRAM = f"""
import queue, threading, time
items = queue.Queue(5)
def produce():
    for number in range({_SECONDS * 10}):
        items.put(number)
        time.sleep(0.1)
    items.put(None)
def consume():
    while items.get() is not None:
        time.sleep(0.01)
threads = [threading.Thread(target=target) for target in (produce, consume)]
for thread in threads: thread.start()
for thread in threads: thread.join()
"""


def universe(context: str = "thread") -> dict[str, float]:
    """Return figures by name.

    Args:
        context: the task context of the kernel.

    Returns:
        `make_ms`, `make_threading_ms`, `make_logging_ms`: making a universe, and importing that module in it;
        `lock.ratio`, `rlock.ratio`, `queue.ratio`: taking and giving back, or a put and a get, against Python's own;
        `round_trip_us`: a message to another thread and back through two queues;
        `program_ms` and `program_speed`: a threaded program of 60 virtual seconds, and its virtual over its real time.
    """
    figures: dict[str, float] = {}
    with Kernel(context=context) as kernel:
        for name, modules in (("make", ()), ("make_threading", ("threading",)), ("make_logging", ("logging",))):
            figures[f"{name}_ms"] = _best(lambda modules=modules: _load(kernel, modules)) / 1e6  # type: ignore[misc]
        _in_task(kernel, lambda: figures.update(_ratios(kernel)))
        _in_task(kernel, lambda: figures.update(round_trip_us=_round_trip(kernel)))
    program = _best(lambda: _run(context), 3) / 1e6
    return figures | {"program_ms": program, "program_speed": _SECONDS * 1e3 / program}


def _in_task(kernel: Kernel, function: Callable[[], object]) -> None:
    kernel.spawn("bench", function)
    kernel.run(kernel.now + 10**12)


def _load(kernel: Kernel, modules: tuple[str, ...]) -> Universe:
    made = Universe(kernel, name="bench")
    for name in modules:
        made.importer.load(name)
    return made


def _ratios(kernel: Kernel) -> dict[str, float]:
    made = _load(kernel, ("threading", "queue"))
    virtual, queues = made.importer.modules["threading"], made.importer.modules["queue"]
    return {
        "lock.ratio": _best(lambda: _cycle(virtual.Lock())) / _best(lambda: _cycle(threading.Lock())),
        "rlock.ratio": _best(lambda: _cycle(virtual.RLock())) / _best(lambda: _cycle(threading.RLock())),
        "queue.ratio": _best(lambda: _pass(queues.Queue())) / _best(lambda: _pass(queue.Queue())),
    }


def _cycle(lock: Any) -> None:
    for _ in range(_CALLS):
        lock.acquire()
        lock.release()


def _pass(items: Any) -> None:
    for number in range(_CALLS // 10):
        items.put(number)
        items.get()


def _round_trip(kernel: Kernel) -> float:
    """Return the microseconds of a round trip."""
    made = _load(kernel, ("threading", "queue"))
    there, back = (made.importer.modules["queue"].Queue() for _ in range(2))

    def echo() -> None:
        while True:
            back.put(there.get())

    task = made.start_thread(echo)

    def exchange() -> None:
        for number in range(_CALLS // 10):
            there.put(number)
            back.get()

    best = _best(exchange)
    kernel.kill(task)
    return best / (_CALLS // 10) / 1e3


def _run(context: str) -> None:
    with tempfile.TemporaryDirectory() as folder, Kernel(context=context, trace=Trace()) as kernel:
        script = Path(folder, "program.py")
        script.write_text(_PROGRAM, encoding="utf-8")
        Universe(kernel, name="program", script=script).spawn()
        kernel.run()


def _best(function: Callable[[], object], rounds: int = _ROUNDS) -> int:
    """Return the shortest of several rounds in ns."""
    best = 1 << 62
    for _ in range(rounds):
        start = perf_counter_ns()
        function()
        best = min(best, perf_counter_ns() - start)
    return best


if __name__ == "__main__":
    for chosen in ("thread", "greenlet"):
        for key, value in universe(chosen).items():
            print(f"{chosen:9} {key:18} {value:10.2f}")
