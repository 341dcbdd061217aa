"""A node's view of its process and of the computer: `gc`, `locale`, `resource` and `psutil`.

The kernel collects garbage at fixed virtual times. If a node could enable automatic collection, finalizers would run
at times that depend on the host. Settings of the whole process are stored for the node that made them, and have no
effect.

`psutil` reports the load of the simulated processor, from the CPU times of the kernel's tasks. All other numbers
describe an idle computer: free memory, no traffic on disks and networks, no sensors. A node has `psutil` whether or not
it is installed on the host.
"""

from __future__ import annotations

import gc
import locale
from types import ModuleType
from typing import TYPE_CHECKING, Any, NamedTuple

from cfepy.nodes.files import DISK_BYTES
from cfepy.nodes.made_modules import made, proxy, rebind

if TYPE_CHECKING:
    from cfepy.nodes.universe import Universe

MEMORY_BYTES = 1 << 30
_S = 1e9


def gc_module(universe: Universe) -> ModuleType:
    """Return `gc`: `collect` collects, `get_objects` lists, and calls that change settings have no effect."""
    state = {"enabled": True, "debug": 0}
    threshold = [700, 10, 10]

    def set_enabled(value: bool) -> None:
        state["enabled"] = value

    def set_threshold(*values: int) -> None:
        threshold[: len(values)] = values

    def set_debug(flags: int) -> None:
        state["debug"] = flags

    def get_objects(generation: int | None = None) -> list[Any]:
        universe.make_hidden_objects()
        return gc.get_objects(generation)

    return proxy(
        gc,
        callbacks=[],
        disable=lambda: set_enabled(False),
        enable=lambda: set_enabled(True),
        freeze=lambda: None,
        get_debug=lambda: state["debug"],
        get_objects=get_objects,
        get_threshold=lambda: tuple(threshold),
        isenabled=lambda: state["enabled"],
        set_debug=set_debug,
        set_threshold=set_threshold,
        unfreeze=lambda: None,
    )


def locale_module(universe: Universe) -> ModuleType:
    """Return `locale`: numbers and dates are written as in the locale "C", whatever a node sets."""
    chosen: dict[int, str] = {}

    def setlocale(category: int, wanted: Any = None) -> str:
        if wanted is not None:
            name = wanted if isinstance(wanted, str) else locale.normalize(".".join(filter(None, wanted)))
            chosen[category] = name or "C.UTF-8"
        return chosen.get(category, chosen.get(locale.LC_ALL, "C"))

    return rebind(locale, setlocale=setlocale, resetlocale=lambda category=locale.LC_ALL: chosen.pop(category, None))


def resource_module(universe: Universe) -> ModuleType:
    """Return `resource`: the processor time of the node; there are no limits, and setting them has no effect."""
    import resource

    def getrusage(who: int) -> Any:
        own = universe.cpu_ns / 1e9 if who != resource.RUSAGE_CHILDREN else 0.0
        return resource.struct_rusage((own, *[0] * 15))

    unlimited = (resource.RLIM_INFINITY, resource.RLIM_INFINITY)
    return proxy(
        resource,
        getrlimit=lambda kind: unlimited,
        getrusage=getrusage,
        prlimit=lambda pid, kind, limits=None: unlimited,
        setrlimit=lambda kind, limits: None,
    )


class CpuTimes(NamedTuple):
    """`psutil.cpu_times`, in s."""

    user: float
    system: float
    idle: float


class MemoryUse(NamedTuple):
    """`psutil.virtual_memory` and `swap_memory`, in bytes."""

    total: int
    available: int
    percent: float
    used: int
    free: int


class Disk(NamedTuple):
    """`psutil.disk_usage`, in bytes."""

    total: int
    used: int
    free: int
    percent: float


class NetTraffic(NamedTuple):
    """`psutil.net_io_counters`."""

    bytes_sent: int = 0
    bytes_recv: int = 0
    packets_sent: int = 0
    packets_recv: int = 0
    errin: int = 0
    errout: int = 0
    dropin: int = 0
    dropout: int = 0


class ProcessMemory(NamedTuple):
    """`psutil.Process.memory_info`, in bytes."""

    rss: int = 0
    vms: int = 0


class CpuMeter:
    """Measures how busy the processor was since the last call.

    Args:
        universe: provides the clock and the kernel.
        only_own: whether to count only the node's tasks.
    """

    def __init__(self, universe: Universe, only_own: bool = False) -> None:
        self._universe = universe
        self._only_own = only_own
        self._before = self._read()

    def _read(self) -> tuple[int, int]:
        kernel = self._universe.kernel
        busy = self._universe.cpu_ns if self._only_own else sum(task.cpu_ns for task in kernel.tasks)
        return kernel.now, busy

    def percent(self, interval: float | None = None) -> float:
        """Return the busy time in %, over the next `interval` seconds, or since the last call."""
        if interval:
            self._before = self._read()
            self._universe.clock.sleep(interval)
        self._universe.charge()
        before, self._before = self._before, self._read()
        passed = self._before[0] - before[0]
        used = max(0, self._before[1] - before[1])  # the time of tasks that have ended is lost
        return round(100.0 * used / passed, 1) if passed else 0.0


class Process:
    """`psutil.Process` of the node itself.

    Args:
        universe: the node's.
        pid: its process number, or None.
    """

    def __init__(self, universe: Universe, pid: int | None = None) -> None:
        if pid not in (None, universe.pid):
            raise NoSuchProcessError(pid)
        self._universe = universe
        self._meter = CpuMeter(universe, only_own=True)
        self.pid = universe.pid

    def name(self) -> str:
        """Return the name that Linux gives a Python program."""
        return "python3"

    def cmdline(self) -> list[str]:
        """Return the program and its arguments."""
        return ["python3", *map(str, self._universe.argv)]

    def cpu_percent(self, interval: float | None = None) -> float:
        return self._meter.percent(interval)

    def cpu_times(self) -> CpuTimes:
        """Return the processor time of the node's tasks."""
        return CpuTimes(self._universe.cpu_ns / _S, 0.0, 0.0)

    def memory_info(self) -> ProcessMemory:
        """Return zeros: memory use is not simulated."""
        return ProcessMemory()

    def memory_percent(self) -> float:
        """As `memory_info`."""
        return 0.0

    def net_connections(self, kind: str = "inet") -> list[Any]:
        """Return an empty list: the simulated network has no table of connections."""
        return []

    connections = net_connections

    def num_threads(self) -> int:
        """Return how many tasks the node has."""
        return len(self._universe.tasks)

    def is_running(self) -> bool:
        """Return True: the process that calls this is running."""
        return True

    def create_time(self) -> float:
        """Return when the computer started, with all that runs on it."""
        return self._universe.clock.epoch_ns / _S


class NoSuchProcessError(Exception):
    """`psutil.NoSuchProcess`."""

    def __init__(self, pid: int | None) -> None:
        super().__init__(f"process PID not found (pid={pid})")
        self.pid = pid


def psutil_module(universe: Universe) -> ModuleType:
    """Return the module `psutil` of a universe."""
    meter = CpuMeter(universe)
    memory = MemoryUse(MEMORY_BYTES, MEMORY_BYTES, 0.0, 0, MEMORY_BYTES)

    def cpu_percent(interval: float | None = None, percpu: bool = False) -> Any:
        busy = meter.percent(interval)
        return [busy] if percpu else busy

    def cpu_times(percpu: bool = False) -> Any:
        busy = sum(task.cpu_ns for task in universe.kernel.tasks)
        times = CpuTimes(busy / _S, 0.0, (universe.kernel.now - busy) / _S)
        return [times] if percpu else times

    empty: dict[str, Any] = {f"sensors_{what}": lambda *args: {} for what in ("fans", "temperatures")}
    return made(
        "psutil",
        **empty,
        Error=Exception,
        NoSuchProcess=NoSuchProcessError,
        Process=lambda pid=None: Process(universe, pid),
        boot_time=lambda: universe.clock.epoch_ns / _S,
        cpu_count=lambda logical=True: 1,
        cpu_freq=lambda percpu=False: None,
        cpu_percent=cpu_percent,
        cpu_times=cpu_times,
        disk_partitions=lambda all=False: [],
        disk_usage=lambda path: Disk(DISK_BYTES, 0, DISK_BYTES, 0.0),
        getloadavg=lambda: (0.0, 0.0, 0.0),
        net_if_addrs=dict,
        net_io_counters=lambda pernic=False, nowrap=True: {"lo": NetTraffic()} if pernic else NetTraffic(),
        pid_exists=lambda pid: pid == universe.pid,
        pids=lambda: [universe.pid],
        process_iter=lambda attrs=None: iter([Process(universe)]),
        sensors_battery=lambda: None,
        swap_memory=lambda: MemoryUse(0, 0, 0.0, 0, 0),
        version_info=(5, 9, 0),
        virtual_memory=lambda: memory,
    )
