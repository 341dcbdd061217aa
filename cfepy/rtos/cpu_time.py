"""CPU time of the host: the time that a process and its threads used, and that other programs kept them waiting.

The stall watch counts it, so that no verdict of a run depends on the load of the computer. Only Linux reports how long
threads were ready. Elsewhere a computing thread looks like a waiting one if many programs compute.
"""

from __future__ import annotations

import contextlib
import os
import threading
import time
from collections.abc import Mapping, Set
from types import MappingProxyType
from typing import NamedTuple

from cfepy.units import NS_PER_S

THREADS = "/proc/self/task"


class Spent(NamedTuple):
    """The time that a process has used so far, in seconds.

    Attributes:
        wall_s: wall-clock time.
        used_s: CPU time of its threads, without the calling one.
        ready_s: time in which these threads were ready but other programs had the CPU.
        by_thread: CPU time of each of these threads, and time in which it was ready, by native number; empty if the
            system does not report it.
    """

    wall_s: float
    used_s: float
    ready_s: float
    by_thread: Mapping[int, tuple[float, float]] = MappingProxyType({})

    def since(self, before: Spent, threads: Set[int]) -> tuple[float, float]:
        """Return the CPU time and the time ready of some threads since an earlier measurement, in s.

        If the system does not report times by thread, this returns the times of the whole process.
        """
        if not self.by_thread:
            return self.used_s - before.used_s, self.ready_s - before.ready_s
        used_s = ready_s = 0.0
        for each in threads & self.by_thread.keys() & before.by_thread.keys():
            now, then = self.by_thread[each], before.by_thread[each]
            used_s += max(0.0, now[0] - then[0])  # less: another thread has its number
            ready_s += max(0.0, now[1] - then[1])
        return used_s, ready_s


class Expenses:
    """Measures the time that this process has used so far, each time it is called.

    The time ready of the process keeps the time of a thread that ends or cannot be read.
    """

    def __init__(self) -> None:
        self._ready_ns = 0
        self._of_threads: dict[str, int] = {}

    def __call__(self) -> Spent:
        """Return the present values, without the calling thread, which only watches."""
        times: dict[int, tuple[float, float]] = {}
        with contextlib.suppress(OSError):
            threads = {*os.listdir(THREADS)} - {str(threading.get_native_id())}
            for gone in self._of_threads.keys() - threads:
                del self._of_threads[gone]
            for thread in threads:
                with contextlib.suppress(OSError, ValueError):
                    used_ns, ready_ns = _times_of(f"{THREADS}/{thread}")
                    times[int(thread)] = used_ns / NS_PER_S, ready_ns / NS_PER_S
                    self._count(thread, ready_ns)
        used_s = time.process_time() - time.thread_time()
        return Spent(time.monotonic(), used_s, self._ready_ns / NS_PER_S, times)

    def _count(self, thread: str, ready_ns: int) -> None:
        before = self._of_threads.get(thread, 0)
        self._ready_ns += ready_ns - (before if ready_ns >= before else 0)  # less: another thread has the number
        self._of_threads[thread] = ready_ns


def _times_of(folder: str) -> tuple[int, int]:
    """Return the CPU time of a thread, and the time in which it was ready while others had the CPU, in ns."""
    with open(f"{folder}/schedstat", encoding="utf-8") as told:
        used_ns, ready_ns = told.read().split()[:2]
    return int(used_ns), int(ready_ns)


def kept_waiting_ns(pid: int) -> int:
    """Return how long a process and its children were ready while other programs had the CPU, in ns.

    It is 0 on systems that do not report it.
    """
    folder, found = f"/proc/{pid}/task", 0
    with contextlib.suppress(OSError):
        for thread in os.listdir(folder):
            with contextlib.suppress(OSError, ValueError):
                found += _times_of(f"{folder}/{thread}")[1]
            with contextlib.suppress(OSError), open(f"{folder}/{thread}/children", encoding="utf-8") as children:
                found += sum(kept_waiting_ns(int(child)) for child in children.read().split())
    return found
