"""`Psp`: the board under a mission as one object, `cfe.psp` (cFE's Platform Support Package).

It boots the board with the console lines of NASA's Linux PSP, provides the processor's name and time, keeps the memory
that outlives resets, and passes resets on to the mission. Names are NASA's in snake case without CFE_PSP_. Functions
for hardware that a simulated board lacks (a segment of machine code, caches, a recorder) fail as on NASA's Linux PSP.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cfepy.config.platform import PlatformConfig
from cfepy.config.versions import VersionFunctions
from cfepy.osal import Osal, OsTime, time_from_total_nanoseconds
from cfepy.psp import addresses as endian
from cfepy.psp.addresses import MEM_ATTR_READWRITE, MEM_EEPROM, MEM_RAM, SIZE_MAX, AllMemory, EepromSpace, PortSpace
from cfepy.psp.exceptions import ExceptionApi
from cfepy.psp.profile import LINUX, RANGES, BoardProfile
from cfepy.psp.retained import EEPROM_BYTES, Retained
from cfepy.psp.watchdog import WATCHDOG_MAX, Watchdog
from cfepy.rtos import Kernel
from cfepy.status import (
    CFE_PSP_ERROR,
    CFE_PSP_ERROR_NOT_IMPLEMENTED,
    CFE_STATUS_EXTERNAL_RESOURCE_FAIL,
    CfeError,
    OsalError,
    status_to_decimal,
)
from cfepy.units import NS_PER_S, NS_PER_US
from cfepy.writing.console import Console

RST_TYPE_PROCESSOR = 1
RST_TYPE_POWERON = 2
RST_SUBTYPE_POWER_CYCLE = 1
RST_SUBTYPE_PUSH_BUTTON = 2
RST_SUBTYPE_HW_SPECIAL_COMMAND = 3
RST_SUBTYPE_HW_WATCHDOG = 4
RST_SUBTYPE_RESET_COMMAND = 5
RST_SUBTYPE_EXCEPTION = 6
RST_SUBTYPE_UNDEFINED_RESET = 7
RST_SUBTYPE_HWDEBUG_RESET = 8
RST_SUBTYPE_BANKSWITCH_RESET = 9
SOFT_TIMEBASE_NAME = "cFS-Master"
SOFT_TIMEBASE_PERIOD_US = 10_000
TICKS_PER_SECOND = 1_000_000_000
RESTART_DELAY_MS = 10_000
EEPROM_ADDRESS = 0x1000_0000
RESET_AREA_ADDRESS = 0x2000_0000
USER_RESERVED_ADDRESS = 0x3000_0000
AREA_ADDRESSES = {
    "reset_area": RESET_AREA_ADDRESS,
    "eeprom": EEPROM_ADDRESS,
    "user_reserved": USER_RESERVED_ADDRESS,
}
"""The addresses of the retained areas, by their names in `Retained`."""
# The modules of NASA's Linux PSP with a counterpart here, their ids, and their console lines.
_MODULES = (
    ("soft_timebase", 0x0110FF00, f"Instantiated software timebase '{SOFT_TIMEBASE_NAME}' running at 10000 usec"),
    ("endian_api", 0x0110FF07, "Host CPU Endian=LITTLE"),
)
_RAM_NOTIMPL = ("ram_notimpl", 0x0110FF03, "Physical RAM access not implemented")
_RAM_DIRECT = ("ram_direct", 0x0110FF03, "Using DIRECT memory mapped RAM implementation")
_PORTS_NOTIMPL = ("port_notimpl", 0x0110FF04, "I/O Port access not implemented")
_PORTS_DIRECT = ("port_direct", 0x0110FF04, "Using DIRECT memory mapped PORT implementation")
_MEMORY_REMOVED = """\
CFE_PSP: Critical Data Store Shared memory segment removed
Reset Area Shared memory segment removed
User Reserved Area Shared memory segment removed"""


class AbsentHardware:
    """The functions of the PSP for absent hardware."""

    console: Console

    def flush_caches(self, cache_type: int, address: int, size: int) -> None:
        """Report that there are no caches (CFE_PSP_FlushCaches)."""
        self.console.write("CFE_PSP_FlushCaches called -- Currently no Linux/OSX/Cygwin implementation")

    def init_ssr(self, bus: int, device: int, device_name: str) -> None:
        """Fail, because there is no solid state recorder (CFE_PSP_InitSSR).

        Raises:
            OsalError: CFE_PSP_ERROR, always.
        """
        raise OsalError(CFE_PSP_ERROR, f"unknown recorder {device_name} on bus {bus}, device {device}")

    def get_volatile_disk_mem(self) -> memoryview:
        """Return the memory of the RAM disk, of size 0, because its files have no addresses
        (CFE_PSP_GetVolatileDiskMem).
        """
        return memoryview(b"")

    def get_kernel_text_segment_info(self) -> memoryview:
        """Fail to return the code of the operating system (CFE_PSP_GetKernelTextSegmentInfo).

        Raises:
            OsalError: CFE_PSP_ERROR_NOT_IMPLEMENTED, always.
        """
        raise OsalError(CFE_PSP_ERROR_NOT_IMPLEMENTED, "the kernel has no text segment")

    def get_cfe_text_segment_info(self) -> memoryview:
        """Fail to return the machine code of the cFE core, because Python has none, unlike NASA's Linux
        (CFE_PSP_GetCFETextSegmentInfo).

        Raises:
            OsalError: CFE_PSP_ERROR_NOT_IMPLEMENTED, always.
        """
        raise OsalError(CFE_PSP_ERROR_NOT_IMPLEMENTED, "the cFE has no text segment")


class RestartType(NamedTuple):
    """The cause of the processor's start: a RST_TYPE_* and a RST_SUBTYPE_*."""

    reset_type: int
    subtype: int


class Timebase(NamedTuple):
    """The result of `get_timebase`: seconds, and ns within the second."""

    upper: int
    lower: int


class PanicError(CfeError):
    """Exception for CFE_PSP_Panic, which ends the run."""


class Psp(EepromSpace, PortSpace, ExceptionApi, AbsentHardware, VersionFunctions):
    """A simulated board.

    Args:
        kernel: its clock and tasks.
        profile: the kind of board.
        config: spacecraft id, processor id and name.
        console: the output of its lines.
        osal: provides the software time base.
        retained: memory that outlives a processor reset; None makes a new one.
        on_restart: called with the reset type, the reason and whether it is a fault; None stops the run.

    Attributes:
        all_memory: the range of all memory; None on a board with `memory: ranges`.
    """

    hto_be16 = be16_to_h = staticmethod(endian.swap_16)
    hto_be32 = be32_to_h = staticmethod(endian.swap_32)
    hto_be64 = be64_to_h = staticmethod(endian.swap_64)
    hto_le16 = le16_to_h = staticmethod(endian.keep_16)
    hto_le32 = le32_to_h = staticmethod(endian.keep_32)
    hto_le64 = le64_to_h = staticmethod(endian.keep_64)
    is_big_endian = staticmethod(endian.is_big_endian)
    is_little_endian = staticmethod(endian.is_little_endian)

    def __init__(
        self,
        kernel: Kernel,
        profile: BoardProfile,
        config: PlatformConfig,
        console: Console,
        osal: Osal,
        *,
        retained: Retained | None = None,
        on_restart: Callable[[int, str, bool], object] | None = None,
    ) -> None:
        super().__init__()
        self.kernel = kernel
        self.profile = profile
        self.config = config
        self._version = config.release.psp_version
        self.console = console
        self.osal = osal
        self.retained = (
            retained
            if retained is not None
            else Retained(cds_bytes=config.es_cds_size, eeprom_bytes=profile.data_flash or EEPROM_BYTES)
        )
        self.on_restart = on_restart
        self._is_resetting = False
        self.exceptions = self.retained.exceptions
        has_watchdog = profile.watchdog_max_ms > 0
        self.watchdog = Watchdog(kernel, self.bite if has_watchdog else None, profile.watchdog_max_ms or WATCHDOG_MAX)
        self.declare_ports(profile.ports)
        self.has_ram_access = profile.memory != LINUX
        self.all_memory = None if profile.memory == RANGES else AllMemory(self._placed_areas)
        if profile.data_flash:
            self.protect_eeprom()
        self._restart_type = RestartType(RST_TYPE_POWERON, RST_SUBTYPE_POWER_CYCLE)
        self.watchdog_init = self.watchdog.init
        self.watchdog_enable = self.watchdog.enable
        self.watchdog_disable = self.watchdog.disable
        self.watchdog_service = self.watchdog.service
        self.watchdog_set = self.watchdog.set

    # -- start and end ---------------------------------------------------------------------------------------------

    def boot(self, reset_type: int = 0, subtype: int = 0) -> RestartType:
        """Start the board, up to where NASA's PSP calls CFE_ES_Main (CFE_PSP_Main, OS_Application_Startup).

        Args:
            reset_type: RST_TYPE_PROCESSOR or RST_TYPE_POWERON; 0 takes the type that the last restart requested.
            subtype: one of RST_SUBTYPE_*; 0 takes the subtype that the hardware reports.

        Returns:
            The type of the start: power-on if no other type was requested.
        """
        known_subtype = subtype or self.retained.next_subtype
        self._announce(known_subtype)
        self._start_modules()
        self._map_memory()
        if self.retained.next_reset_type:
            how = "Normal" if self.retained.exited else "Abnormal"
            self.console.write(f"CFE_PSP: {how} exit from previous cFE instance")
        wanted = reset_type or self.retained.next_reset_type
        is_processor = wanted == RST_TYPE_PROCESSOR
        self._restart_type = RestartType(
            RST_TYPE_PROCESSOR if is_processor else RST_TYPE_POWERON, known_subtype or RST_SUBTYPE_POWER_CYCLE
        )
        self.console.write(f"CFE_PSP: Starting the cFE with a {'PROCESSOR' if is_processor else 'POWER ON'} reset.")
        if not is_processor:
            self._clear_memory()
        self.retained.exited = False
        self.retained.next_subtype = 0
        # The reset type after an end without a restart: a processor reset once, then power-on.
        self.retained.next_reset_type = RST_TYPE_POWERON if is_processor else RST_TYPE_PROCESSOR
        return self._restart_type

    def restart(self, reset_type: int, reason: str = "CFE_PSP_Restart", fault: bool = False) -> None:
        """Reset the processor, and record the type of the next start (CFE_PSP_Restart). The call does not return to a
        task.

        Args:
            reset_type: RST_TYPE_PROCESSOR or RST_TYPE_POWERON.
            reason: the reason for the report of the run.
            fault: whether a failure caused it; otherwise it was requested.
        """
        if not self._is_resetting:  # otherwise a `finally` block of a task that is being ended would request it again
            self._is_resetting = True
            self._say_goodbye(reset_type)
        self._reset(reset_type, reason, fault)

    def _say_goodbye(self, reset_type: int) -> None:
        """Print the console lines of the reset, and record it in the retained memory."""
        is_poweron = reset_type == RST_TYPE_POWERON
        self.console.write(f"CFE_PSP: Exiting cFE with {'POWERON' if is_poweron else 'PROCESSOR'} Reset status.")
        if is_poweron:
            self.console.write(_MEMORY_REMOVED)
        self.console.write("\nCFE_PSP: Shutdown initiated - Exiting cFE")
        self.retained.next_reset_type = 0 if is_poweron else reset_type  # the boot record is removed too
        self.retained.exited = not is_poweron

    def bite(self, reason: str = "") -> None:
        """Reset the processor by the watchdog, which software cannot prevent.

        Args:
            reason: the reason; empty means that no task served the watchdog in time.
        """
        self.retained.next_reset_type = RST_TYPE_PROCESSOR
        self.retained.next_subtype = RST_SUBTYPE_HW_WATCHDOG
        self._reset(RST_TYPE_PROCESSOR, reason or f"the watchdog was not served for {self.watchdog.value_ms} ms", True)

    def _reset(self, reset_type: int, reason: str, fault: bool) -> None:
        if self.on_restart is not None:
            self.on_restart(reset_type, reason, fault)
        else:
            self.kernel.stop()
        if self.kernel.current is not self.kernel.host:
            self.osal.task_delay(RESTART_DELAY_MS)
            self.osal.task_exit()

    def panic(self, error_code: int, cause: object = None) -> None:
        """End the run after a fatal error (CFE_PSP_Panic).

        Args:
            error_code: code for the console.
            cause: the reason in the text of the exception.

        Raises:
            PanicError: always; NASA's PSP calls abort().
        """
        self.console.write(f"CFE_PSP_Panic called with error code = 0x{error_code & 0xFFFFFFFF:08X}. Exiting.")
        self.console.write("The cFE could not start.")
        because = "" if cause is None else f": {cause}"
        raise PanicError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, f"PSP panic, code {error_code}{because}")

    def get_restart_type(self) -> RestartType:
        """Return the type and subtype of the start of this run (CFE_PSP_GetRestartType)."""
        return self._restart_type

    # -- identity and time --------------------------------------------------------------------------------------------

    def get_spacecraft_id(self) -> int:
        """Return the number of the spacecraft (CFE_PSP_GetSpacecraftId)."""
        return self.config.spacecraft_id

    def get_processor_id(self) -> int:
        """Return the number of the processor (CFE_PSP_GetProcessorId)."""
        return self.config.processor_id

    def get_processor_name(self) -> str:
        """Return the name of the processor (CFE_PSP_GetProcessorName)."""
        return self.config.processor_name

    def get_time(self) -> OsTime:
        """Return the monotonic time since the start, in OSAL's ticks of 100 ns (CFE_PSP_GetTime)."""
        return time_from_total_nanoseconds(self.kernel.now)

    def get_timebase(self) -> Timebase:
        """Return the same as whole seconds and ns (CFE_PSP_Get_Timebase)."""
        return Timebase(*divmod(self.kernel.now, NS_PER_S))

    def get_timer_ticks_per_second(self) -> int:
        """Return the ticks per second of the lower part of `get_timebase` (CFE_PSP_GetTimerTicksPerSecond)."""
        return TICKS_PER_SECOND

    def get_timer_low32_rollover(self) -> int:
        """Return the value at which that part wraps around (CFE_PSP_GetTimerLow32Rollover)."""
        return TICKS_PER_SECOND

    # -- memory ----------------------------------------------------------------------------------------------------

    def get_cds_size(self) -> int:
        """Return the bytes of the critical data store (CFE_PSP_GetCDSSize)."""
        return len(self.retained.cds)

    def write_to_cds(self, data: bytes | bytearray | memoryview, cds_offset: int) -> None:
        """Copy bytes into the critical data store (CFE_PSP_WriteToCDS).

        Raises:
            OsalError: CFE_PSP_ERROR if the bytes do not lie within it.
        """
        self._check_cds(cds_offset, len(data))
        self.retained.cds[cds_offset : cds_offset + len(data)] = data

    def read_from_cds(self, cds_offset: int, num_bytes: int) -> bytes:
        """Copy bytes out of the critical data store (CFE_PSP_ReadFromCDS).

        Raises:
            OsalError: CFE_PSP_ERROR if the bytes do not lie within it.
        """
        self._check_cds(cds_offset, num_bytes)
        return bytes(self.retained.cds[cds_offset : cds_offset + num_bytes])

    def get_reset_area(self) -> memoryview:
        """Return the memory that outlives a processor reset (CFE_PSP_GetResetArea)."""
        return memoryview(self.retained.reset_area)

    def get_user_reserved_area(self) -> memoryview:
        """Return the memory for users that outlives a processor reset (CFE_PSP_GetUserReservedArea)."""
        return memoryview(self.retained.user_reserved)

    def move_area(self, name: str, make: Callable[[int], bytearray | memoryview]) -> None:
        """Move an area of the retained memory to another place; its bytes are kept.

        Args:
            name: "reset_area", "user_reserved" or "eeprom".
            make: returns room for the given number of bytes. An earlier view of the area still shows the old place.
        """
        before = getattr(self.retained, name)
        after = make(len(before))
        after[:] = before
        setattr(self.retained, name, after)
        for number, area in self._areas.items():
            if area is before:
                self._areas[number] = after

    def compute(self, microseconds: int) -> None:
        """Use virtual CPU time in the calling task, in place of code whose execution time matters (not a function of
        NASA's).

        Args:
            microseconds: virtual CPU time in us. More urgent tasks run meanwhile, and the work continues after them.

        Raises:
            TypeError: if it is not a whole number.
            ValueError: if it is negative.
        """
        self.kernel.compute(microseconds * NS_PER_US)

    def watchdog_get(self) -> int:
        """Return the watchdog's time in ms (CFE_PSP_WatchdogGet)."""
        return self.watchdog.value_ms

    status_to_string = staticmethod(status_to_decimal)

    def _announce(self, subtype: int) -> None:
        """Print the name of the computer and the reset's subtype; 0 means the default."""
        ids = {"processor_id": "CPU ID", "spacecraft_id": "Spacecraft ID"}
        numbers = {title: getattr(self.config, name) for name, title in ids.items()}
        given = [ids[name] for name in self.config.given]
        for title in given:
            self.console.write(f"CFE_PSP: {title}: {numbers[title]}")
        if subtype:
            self.console.write(f"CFE_PSP: Reset SubType: {subtype}")
        else:
            self.console.write(f"CFE_PSP: Default Reset SubType = {RST_SUBTYPE_POWER_CYCLE}")
        for title in numbers:
            if title not in given:
                self.console.write(f"CFE_PSP: Default {title} = {numbers[title]}")
        self.console.write(f"CFE_PSP: Default CPU Name: {self.config.processor_name}")

    def _start_modules(self) -> None:
        timebase = self.osal.time_base_create(SOFT_TIMEBASE_NAME)
        self.osal.time_base_set(timebase, SOFT_TIMEBASE_PERIOD_US, SOFT_TIMEBASE_PERIOD_US)
        self.osal.add_one_hz_timer(timebase)
        ports = _PORTS_DIRECT if self.profile.ports else _PORTS_NOTIMPL
        ram = _RAM_DIRECT if self.has_ram_access else _RAM_NOTIMPL
        for name, module_id, says in (_MODULES[0], ram, ports, *_MODULES[1:]):
            self.console.write(f"CFE_PSP: initializing module '{name}' with ID {module_id:08x}")
            self.console.write(f"CFE_PSP: {says}")

    def _map_memory(self) -> None:
        """Map the areas to addresses. The EEPROM is the second range. On Linux the first is all of memory."""
        kept, eeprom = self.retained, self.retained.eeprom
        self.mem_range_set(1, MEM_EEPROM, EEPROM_ADDRESS, len(eeprom), 4, MEM_ATTR_READWRITE, eeprom)
        if self.all_memory is not None:
            self.mem_range_set(0, MEM_RAM, 0, SIZE_MAX, 4, MEM_ATTR_READWRITE, self.all_memory)
        else:
            for number, address, area in (
                (0, RESET_AREA_ADDRESS, kept.reset_area),
                (2, USER_RESERVED_ADDRESS, kept.user_reserved),
            ):
                self.mem_range_set(number, MEM_RAM, address, len(area), 4, MEM_ATTR_READWRITE, area)
        self.console.write(
            f"CFE_PSP: EEPROM Range (2) created: Start Address = {EEPROM_ADDRESS:08X}, "
            f"Size = {len(eeprom):08X} Status = 0"
        )

    def _placed_areas(self) -> list[tuple[int, bytearray | memoryview]]:
        return [(address, getattr(self.retained, name)) for name, address in AREA_ADDRESSES.items()]

    def _clear_memory(self) -> None:
        for area in ("CDS", "Reset", "User Reserved"):
            self.console.write(f"CFE_PSP: Clearing out CFE {area} Shared memory segment.")
        self.retained.clear()

    def _check_cds(self, offset: int, size: int) -> None:
        if offset < 0 or size < 0 or offset >= len(self.retained.cds) or offset + size > len(self.retained.cds):
            raise OsalError(CFE_PSP_ERROR, f"{size} bytes at {offset} are outside the CDS of {len(self.retained.cds)}")
