"""The CPU of the host that the threads of a run share.

Only one of these threads runs at a time, and a hand-over between two CPUs costs up to fifteen times as much. So all of
them are pinned to one CPU. Two processes pinned to the same CPU would delay each other for their whole lifetime,
because the host's scheduler cannot separate them. So each process claims a seat: a CPU that no other cfepy process has.
If every CPU is taken, it claims one with the fewest processes. The process gives the seat back when it has no run left.

A seat is the name of a socket in Linux's abstract namespace to which nothing is ever sent. Only one process can have
the name, no file is left behind, and the system releases it whenever the process ends.

    CFEPY_PIN=auto    the default
    CFEPY_PIN=3       the runs of this process are pinned to CPU 3
    CFEPY_PIN=off     they are not pinned
"""

from __future__ import annotations

import os
import sys
import threading
import weakref

from cfepy.interpreter.host_system import in_forked_process
from cfepy.status import UsageError

VARIABLE = "CFEPY_PIN"
NAME = "cfepy on CPU"
MOST_ON_ONE = 64  # number of processes on one CPU at which counting ends
_CAN_PIN = hasattr(os, "sched_setaffinity")
_CAN_CLAIM = sys.platform == "linux"


def allowed_cpus() -> list[int]:
    """Return the numbers of the CPUs that the calling thread may use."""
    return sorted(os.sched_getaffinity(0)) if _CAN_PIN else list(range(os.cpu_count() or 1))


def current_cpu() -> int:
    """Return the CPU that the calling thread runs on, or -1 if it is unknown or pinning is not possible."""
    if not _CAN_PIN:
        return -1
    try:
        with open("/proc/thread-self/stat", "rb") as stat:
            cpu = int(stat.read().rpartition(b")")[2].split()[36])
    except (OSError, ValueError, IndexError):
        return -1
    return cpu if cpu in os.sched_getaffinity(0) else -1


def pin(native_id: int, cpu: int) -> None:
    """Pin a thread of this process to one CPU; 0 is the calling thread."""
    if _CAN_PIN:
        os.sched_setaffinity(native_id, {cpu})


class _Claim:
    """A claimed place on a CPU, for as long as this object lives; use `_claim`."""

    __slots__ = ("_socket", "cpu", "others")

    def __init__(self, cpu: int, others: int) -> None:
        from _socket import AF_UNIX, SOCK_DGRAM, socket  # `socket` itself would take a tenth of the boot time

        self.cpu, self.others = cpu, others
        self._socket = socket(AF_UNIX, SOCK_DGRAM)
        try:
            self._socket.bind(f"\0{NAME} {cpu}, {others}")
        except OSError:
            self._socket.close()
            raise

    def give_back(self) -> None:
        self._socket.close()


def _claim(cpu: int, others: int) -> _Claim | None:
    """Claim the place on a CPU after `others` earlier ones; return None if another process has it."""
    try:
        return _Claim(cpu, others)
    except OSError:
        return None


class Seat:
    """The CPU of this process's runs, from `process_seat`.

    It is given back when the last reference to it goes.

    Attributes:
        lock: protects the choice, because several threads can make runs.
    """

    def __init__(self) -> None:
        self._claimed: _Claim | None = None
        self.lock = threading.Lock()

    def __del__(self) -> None:
        self.leave()

    @property
    def cpu(self) -> int:
        """The CPU, or -1 before the first choice."""
        return -1 if self._claimed is None else self._claimed.cpu

    def leave(self) -> None:
        """Give the CPU back."""
        claimed, self._claimed = self._claimed, None
        if claimed is not None:
            claimed.give_back()

    def choose(self, here: int) -> int:
        """Return the CPU for a run that is about to continue, or -1 for any.

        Args:
            here: the current CPU of the host's thread. The system chose it, perhaps to avoid a CPU that another program
                keeps busy. So it is taken unless more cfepy processes are on it.

        Raises:
            UsageError: if CFEPY_PIN is invalid, or a CPU that this process may not use.
        """
        wanted = os.environ.get(VARIABLE, "auto")
        if wanted != "auto":
            return _chosen_by_user(wanted)
        if here < 0 or not _CAN_CLAIM:
            return here
        with self.lock:
            found = self._better(here)
            if found is not None:
                self.leave()
                self._claimed = found
            return here if self._claimed is None else self._claimed.cpu

    def _better(self, here: int) -> _Claim | None:
        """Return a place with fewer other processes than the present one, or with as many if it is on the
        host's CPU.
        """
        now = self._claimed
        if now is not None and now.cpu == here and not now.others:
            return None
        cpus = allowed_cpus()
        cpus.sort(key=lambda cpu: cpu != here)
        for others in range(MOST_ON_ONE if now is None else now.others + 1):
            for cpu in cpus:
                is_as_good = now is not None and others == now.others
                if is_as_good and cpu != here:
                    break
                found = _claim(cpu, others)
                if found is not None:
                    return found
        return None


def _chosen_by_user(wanted: str) -> int:
    if wanted == "off":
        return -1
    cpus = allowed_cpus()
    if not wanted.isdecimal() or int(wanted) not in cpus:
        known = ", ".join(map(str, cpus))
        raise UsageError(f"invalid {VARIABLE}={wanted}; expected auto, off or a CPU that this process may use: {known}")
    return int(wanted)


_shared: weakref.ref[Seat] | None = None
_asking = threading.Lock()


def process_seat() -> Seat:
    """Return the seat that all runs of this process share, because Python runs one thread of a process at a time."""
    global _shared
    with _asking:
        seat = None if _shared is None else _shared()
        if seat is None:
            seat = Seat()
            _shared = weakref.ref(seat)
        return seat


def _in_forked_process() -> None:
    """Drop the parent's seat. The child's copy of the socket must not outlive the parent, and the child takes its own
    seat.
    """
    global _asking
    _asking = threading.Lock()
    seat = None if _shared is None else _shared()
    if seat is not None:
        seat.leave()
        seat.lock = threading.Lock()


in_forked_process(_in_forked_process)
