"""CFE_PSP_IODriver_*: the PSP's drivers for C. NASA's Linux PSP has one, `linux_sysmon`, which reports the CPU's load.

The load is the simulated processor's: the virtual time that its tasks have used in the last 30 s.
"""

from __future__ import annotations

from struct import Struct
from typing import TYPE_CHECKING

from cfepy.rtos import Kernel, Task
from cfepy.status import (
    CFE_PSP_ERROR,
    CFE_PSP_ERROR_NOT_IMPLEMENTED,
    CFE_PSP_INVALID_MODULE_NAME,
    CFE_PSP_SUCCESS,
)
from cfepy.units import NS_PER_MS, NS_PER_S

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

MODULES = (
    *("soft_timebase", "timebase_posix_clock", "eeprom_mmap_file", "ram_notimpl"),
    *("port_notimpl", "iodriver", "linux_sysmon", "endian_api"),
)
"""The modules of NASA's Linux PSP, with successive ids."""
FIRST_ID = 0x0110FF00
DRIVER = "linux_sysmon"
LOCATION = Struct("<IHH")
"""CFE_PSP_IODriver_Location_t: module, subsystem, subchannel."""
READING = Struct("<H6xQ")
"""CFE_PSP_IODriver_AnalogRdWr_t: number of channels, and address for the samples."""
NOOP, SET_RUNNING, GET_RUNNING, LOOKUP_SUBSYSTEM, LOOKUP_SUBCHANNEL, QUERY_DIRECTION = 0, 1, 2, 5, 6, 8
ANALOG_NOOP, ANALOG_READ = 0x10000, 0x10001
INPUT_ONLY = 1
AGGREGATE, PER_CPU = 0, 1
SUBSYSTEMS = ("aggregate", "per-cpu")
SUBCHANNELS = ("cpu-load",)
SAMPLE_S = 30
START_MS = 10
FULL_LOAD = 0xFFFFFF
_PRIORITY = 0


class CpuMonitor:
    """Measures the load of the processor.

    Args:
        kernel: the processor.

    Attributes:
        load: the last sample, 0 to `FULL_LOAD`.
        has_started: whether it was ever started.
    """

    def __init__(self, kernel: Kernel) -> None:
        self.load = 0
        self.has_started = False
        self._kernel = kernel
        self._task: Task | None = None

    @property
    def is_running(self) -> bool:
        """Whether it is measuring."""
        return self._task is not None

    def start(self) -> None:
        """Begin to measure. The first sample is available after 30 s."""
        self.load = 0
        self.has_started = True
        self._task = self._kernel.spawn(DRIVER, self._measure, _PRIORITY)

    def stop(self) -> None:
        """Stop measuring. The last sample stays."""
        if self._task is not None:
            self._kernel.kill(self._task)
            self._task = None

    def _measure(self) -> None:
        self._kernel.current.owner = None  # it belongs to the board, not to the application that started it
        busy = self._busy_ns()
        while True:
            self._kernel.delay(SAMPLE_S * NS_PER_S)
            before, busy = busy, self._busy_ns()
            self.load = load_of(max(busy - before, 0), SAMPLE_S * NS_PER_S)

    def _busy_ns(self) -> int:
        return sum(task.cpu_ns for task in self._kernel.tasks)


def load_of(busy_ns: int, elapsed_ns: int) -> int:
    """Return a share of time in the driver's form: its 12 bits, twice."""
    busy_ms, elapsed_ms = busy_ns // NS_PER_MS, elapsed_ns // NS_PER_MS
    if busy_ms >= elapsed_ms:
        return FULL_LOAD
    share = 0x1000 * busy_ms // elapsed_ms
    return share | share << 12


class SystemMonitor:
    """The driver `linux_sysmon`.

    Args:
        c: the C side of the processor.
    """

    def __init__(self, c: CRuntime) -> None:
        self._c = c
        self._cpu = CpuMonitor(c.kernel)

    def command(self, code: int, subsystem: int, subchannel: int, argument: int) -> int:
        """Execute a command. Returns a status, or the requested value."""
        if subsystem not in (AGGREGATE, PER_CPU):
            return CFE_PSP_ERROR_NOT_IMPLEMENTED
        if code in (NOOP, ANALOG_NOOP):
            return CFE_PSP_SUCCESS
        if subsystem == PER_CPU:
            return self._read_each(subchannel, argument) if code == ANALOG_READ else CFE_PSP_ERROR_NOT_IMPLEMENTED
        return self._aggregate(code, subchannel, argument)

    def _aggregate(self, code: int, subchannel: int, argument: int) -> int:
        if code == SET_RUNNING:
            return self._set_running(argument & 0xFFFFFFFF != 0)
        if code == GET_RUNNING:
            return self._cpu.is_running
        if code in (LOOKUP_SUBSYSTEM, LOOKUP_SUBCHANNEL):
            names = SUBSYSTEMS if code == LOOKUP_SUBSYSTEM else SUBCHANNELS
            wanted = self._c.memory.text(argument)
            return names.index(wanted) if wanted in names else CFE_PSP_ERROR_NOT_IMPLEMENTED
        if code == QUERY_DIRECTION and argument:
            self._c.memory.put_u32(argument, INPUT_ONLY)
            return CFE_PSP_SUCCESS
        if code == ANALOG_READ:
            return self._read_all(subchannel, argument)
        return CFE_PSP_ERROR_NOT_IMPLEMENTED

    def _set_running(self, wanted: bool) -> int:
        if not wanted:
            self._cpu.stop()
        elif not self._cpu.is_running:
            self._cpu.start()
            self._c.handle.os.task_delay(START_MS)
            self._c.handle.os.printf("CFE_PSP(Linux_SysMon): Started CPU utilization monitoring on 1 CPU(s)")
        return CFE_PSP_SUCCESS

    def _read_all(self, subchannel: int, argument: int) -> int:
        count, samples = READING.unpack(self._c.memory.peek(argument, READING.size))
        if count != 1 or subchannel != 0:
            return CFE_PSP_ERROR_NOT_IMPLEMENTED
        self._c.memory.put_u32(samples, self._cpu.load)
        return CFE_PSP_SUCCESS if self._cpu.has_started else CFE_PSP_ERROR

    def _read_each(self, subchannel: int, argument: int) -> int:
        """Read the load of each CPU; there is one. NASA's driver gives the samples, but returns "not implemented"."""
        count, samples = READING.unpack(self._c.memory.peek(argument, READING.size))
        if self._cpu.has_started and subchannel == 0 and count == 1:
            self._c.memory.put_u32(samples, self._cpu.load)
        return CFE_PSP_ERROR_NOT_IMPLEMENTED


def declare(api: Declarations, c: CRuntime) -> None:
    monitor = SystemMonitor(c)

    def find_by_name(name: str, module_id: int) -> int:
        found = MODULES.index(name) + FIRST_ID if name in MODULES else 0
        c.memory.put_u32(module_id, found)
        return CFE_PSP_SUCCESS if name == DRIVER else CFE_PSP_INVALID_MODULE_NAME

    def command(location: int, code: int, argument: int) -> int:
        module_id, subsystem, subchannel = LOCATION.unpack(c.memory.peek(location, LOCATION.size))
        if module_id != FIRST_ID + MODULES.index(DRIVER):
            return CFE_PSP_ERROR_NOT_IMPLEMENTED
        return monitor.command(code, subsystem, subchannel, argument)

    api.add("CFE_PSP_IODriver_FindByName", "Sp", find_by_name, CFE_PSP_INVALID_MODULE_NAME)
    api.add("CFE_PSP_IODriver_Command", "$pIQ", command)
