"""`Psp`: the board under a mission as one object, `cfe.psp` (cFE's Platform Support Package).

It boots the board with the console lines of NASA's Linux PSP, gives the processor's name and time, keeps the memory
that outlives resets, and passes resets on to the mission. Names are NASA's in snake case without CFE_PSP_. What a
simulated board does not have (a segment of machine code, caches, a recorder) fails as on NASA's Linux PSP.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

from cfepy.config.platform import PlatformConfig
from cfepy.config.versions import PSP_VERSION, VersionFunctions
from cfepy.osal import Osal, OsTime, time_from_total_nanoseconds
from cfepy.psp import addresses as endian
from cfepy.psp.addresses import MEM_ATTR_READWRITE, MEM_EEPROM, MEM_RAM, EepromSpace, PortSpace
from cfepy.psp.exceptions import ExceptionApi
from cfepy.psp.profile import BoardProfile
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
# The modules of NASA's Linux PSP that there is a counterpart of here, with their ids there and what they say.
_MODULES = (
    ("soft_timebase", 0x0110FF00, f"Instantiated software timebase '{SOFT_TIMEBASE_NAME}' running at 10000 usec"),
    ("ram_notimpl", 0x0110FF03, "Physical RAM access not implemented"),
    ("endian_api", 0x0110FF07, "Host CPU Endian=LITTLE"),
)
_PORTS_NOTIMPL = ("port_notimpl", 0x0110FF04, "I/O Port access not implemented")
_PORTS_DIRECT = ("port_direct", 0x0110FF04, "Using DIRECT memory mapped PORT implementation")
_MEMORY_REMOVED = """\
CFE_PSP: Critical Data Store Shared memory segment removed
Reset Area Shared memory segment removed
User Reserved Area Shared memory segment removed"""


class AbsentHardware:
    """The functions of the PSP that find nothing."""

    console: Console

    def flush_caches(self, cache_type: int, address: int, size: int) -> None:
        """Say that there are none (CFE_PSP_FlushCaches)."""
        self.console.write("CFE_PSP_FlushCaches called -- Currently no Linux/OSX/Cygwin implementation")

    def init_ssr(self, bus: int, device: int, device_name: str) -> None:
        """There is no solid state recorder (CFE_PSP_InitSSR).

        Raises:
            OsalError: CFE_PSP_ERROR, always.
        """
        raise OsalError(CFE_PSP_ERROR, f"unknown recorder {device_name} on bus {bus}, device {device}")

    def get_volatile_disk_mem(self) -> memoryview:
        """The memory of the RAM disk, of size 0: its files are no bytes at addresses (CFE_PSP_GetVolatileDiskMem)."""
        return memoryview(b"")

    def get_kernel_text_segment_info(self) -> memoryview:
        """The code of the operating system (CFE_PSP_GetKernelTextSegmentInfo).

        Raises:
            OsalError: CFE_PSP_ERROR_NOT_IMPLEMENTED, always.
        """
        raise OsalError(CFE_PSP_ERROR_NOT_IMPLEMENTED, "the kernel has no text segment")

    def get_cfe_text_segment_info(self) -> memoryview:
        """The machine code of the cFE core (CFE_PSP_GetCFETextSegmentInfo): Python has none, unlike NASA's Linux.

        Raises:
            OsalError: CFE_PSP_ERROR_NOT_IMPLEMENTED, always.
        """
        raise OsalError(CFE_PSP_ERROR_NOT_IMPLEMENTED, "the cFE has no text segment")


class RestartType(NamedTuple):
    """Why the processor started: a RST_TYPE_* and a RST_SUBTYPE_*."""

    reset_type: int
    subtype: int


class Timebase(NamedTuple):
    """What `get_timebase` reads: seconds, and ns within the second."""

    upper: int
    lower: int


class PanicError(CfeError):
    """CFE_PSP_Panic was called: the run is over."""


class Psp(EepromSpace, PortSpace, ExceptionApi, AbsentHardware, VersionFunctions):
    """One board.

    Args:
        kernel: its clock and tasks.
        profile: what kind of board it is.
        config: spacecraft id, processor id and name.
        console: where its lines go.
        osal: for the software time base.
        retained: memory that outlives a processor reset; None makes a new one.
        on_restart: called with the reset type, the reason and whether it is a fault; None stops the run.
    """

    hto_be16 = be16_to_h = staticmethod(endian.swap_16)
    hto_be32 = be32_to_h = staticmethod(endian.swap_32)
    hto_be64 = be64_to_h = staticmethod(endian.swap_64)
    hto_le16 = le16_to_h = staticmethod(endian.keep_16)
    hto_le32 = le32_to_h = staticmethod(endian.keep_32)
    hto_le64 = le64_to_h = staticmethod(endian.keep_64)
    _version = PSP_VERSION
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
            reset_type: RST_TYPE_PROCESSOR or RST_TYPE_POWERON; 0 takes what the last restart asked for.
            subtype: one of RST_SUBTYPE_*; 0 takes what the hardware says.

        Returns:
            The type of the start: power-on when nothing else was asked for.
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
        # What comes when it ends without a restart: once a processor reset, then from scratch.
        self.retained.next_reset_type = RST_TYPE_POWERON if is_processor else RST_TYPE_PROCESSOR
        return self._restart_type

    def restart(self, reset_type: int, reason: str = "CFE_PSP_Restart", fault: bool = False) -> None:
        """Reset the processor, and record how it starts again (CFE_PSP_Restart). A task does not come back from it.

        Args:
            reset_type: RST_TYPE_PROCESSOR or RST_TYPE_POWERON.
            reason: for the report of the run.
            fault: something failed; otherwise it was asked for.
        """
        if not self._is_resetting:  # else a `finally` block of a task that is being ended asks once more
            self._is_resetting = True
            self._say_goodbye(reset_type)
        self._reset(reset_type, reason, fault)

    def _say_goodbye(self, reset_type: int) -> None:
        """What is said, and what the retained memory knows of the reset."""
        is_poweron = reset_type == RST_TYPE_POWERON
        self.console.write(f"CFE_PSP: Exiting cFE with {'POWERON' if is_poweron else 'PROCESSOR'} Reset status.")
        if is_poweron:
            self.console.write(_MEMORY_REMOVED)
        self.console.write("\nCFE_PSP: Shutdown initiated - Exiting cFE")
        self.retained.next_reset_type = 0 if is_poweron else reset_type  # the boot record is removed too
        self.retained.exited = not is_poweron

    def bite(self, reason: str = "") -> None:
        """The watchdog resets the processor; software has no say in it.

        Args:
            reason: why; empty stands for the usual one, that no task served it in time.
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
        """The cFE cannot go on (CFE_PSP_Panic).

        Args:
            error_code: for the console.
            cause: what the error that is raised tells as its reason.

        Raises:
            PanicError: always; NASA's calls abort().
        """
        self.console.write(f"CFE_PSP_Panic called with error code = 0x{error_code & 0xFFFFFFFF:08X}. Exiting.")
        self.console.write("The cFE could not start.")
        because = "" if cause is None else f": {cause}"
        raise PanicError(CFE_STATUS_EXTERNAL_RESOURCE_FAIL, f"PSP panic, code {error_code}{because}")

    def get_restart_type(self) -> RestartType:
        """Type and subtype of the start of this run (CFE_PSP_GetRestartType)."""
        return self._restart_type

    # -- who and when ----------------------------------------------------------------------------------------------

    def get_spacecraft_id(self) -> int:
        """Number of the spacecraft (CFE_PSP_GetSpacecraftId)."""
        return self.config.spacecraft_id

    def get_processor_id(self) -> int:
        """Number of the processor (CFE_PSP_GetProcessorId)."""
        return self.config.processor_id

    def get_processor_name(self) -> str:
        """Name of the processor (CFE_PSP_GetProcessorName)."""
        return self.config.processor_name

    def get_time(self) -> OsTime:
        """Monotonic time since the start, in OSAL's ticks of 100 ns (CFE_PSP_GetTime)."""
        return time_from_total_nanoseconds(self.kernel.now)

    def get_timebase(self) -> Timebase:
        """The same as whole seconds and ns (CFE_PSP_Get_Timebase)."""
        return Timebase(*divmod(self.kernel.now, NS_PER_S))

    def get_timer_ticks_per_second(self) -> int:
        """Ticks per second of the lower part of `get_timebase` (CFE_PSP_GetTimerTicksPerSecond)."""
        return TICKS_PER_SECOND

    def get_timer_low32_rollover(self) -> int:
        """Where that part begins anew (CFE_PSP_GetTimerLow32Rollover)."""
        return TICKS_PER_SECOND

    # -- memory ----------------------------------------------------------------------------------------------------

    def get_cds_size(self) -> int:
        """Bytes of the critical data store (CFE_PSP_GetCDSSize)."""
        return len(self.retained.cds)

    def write_to_cds(self, data: bytes | bytearray | memoryview, cds_offset: int) -> None:
        """Copy bytes into the critical data store (CFE_PSP_WriteToCDS).

        Raises:
            OsalError: CFE_PSP_ERROR when they do not lie within it.
        """
        self._check_cds(cds_offset, len(data))
        self.retained.cds[cds_offset : cds_offset + len(data)] = data

    def read_from_cds(self, cds_offset: int, num_bytes: int) -> bytes:
        """Copy bytes out of the critical data store (CFE_PSP_ReadFromCDS).

        Raises:
            OsalError: CFE_PSP_ERROR when they do not lie within it.
        """
        self._check_cds(cds_offset, num_bytes)
        return bytes(self.retained.cds[cds_offset : cds_offset + num_bytes])

    def get_reset_area(self) -> memoryview:
        """The memory that outlives a processor reset (CFE_PSP_GetResetArea)."""
        return memoryview(self.retained.reset_area)

    def get_user_reserved_area(self) -> memoryview:
        """The same for users (CFE_PSP_GetUserReservedArea)."""
        return memoryview(self.retained.user_reserved)

    def move_area(self, name: str, make: Callable[[int], bytearray | memoryview]) -> None:
        """Keep an area of the retained memory elsewhere from now on; its bytes stay what they are.

        Args:
            name: "reset_area", "user_reserved" or "eeprom".
            make: gives room for so many bytes. A view that was taken of the area before still shows the old place.
        """
        before = getattr(self.retained, name)
        after = make(len(before))
        after[:] = before
        setattr(self.retained, name, after)
        for number, area in self._areas.items():
            if area is before:
                self._areas[number] = after

    def compute(self, microseconds: int) -> None:
        """The calling task works for so long: a stand-in for code whose time counts (no function of NASA's).

        Args:
            microseconds: of virtual CPU time. More urgent tasks get in meanwhile, and the work goes on behind them.

        Raises:
            TypeError: it is no whole number.
            ValueError: it is negative.
        """
        self.kernel.compute(microseconds * NS_PER_US)

    def watchdog_get(self) -> int:
        """The watchdog's time in ms (CFE_PSP_WatchdogGet)."""
        return self.watchdog.value_ms

    status_to_string = staticmethod(status_to_decimal)

    def _announce(self, subtype: int) -> None:
        """Print the name of the computer and the reset's subtype; 0 stands for the default one."""
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
        ports = _PORTS_DIRECT if self.profile.ports else _PORTS_NOTIMPL
        for name, module_id, says in (*_MODULES[:2], ports, *_MODULES[2:]):
            self.console.write(f"CFE_PSP: initializing module '{name}' with ID {module_id:08x}")
            self.console.write(f"CFE_PSP: {says}")

    def _map_memory(self) -> None:
        """Give the areas that are bytes here an address; the EEPROM is the second range, as in NASA's."""
        kept, eeprom = self.retained, self.retained.eeprom
        for number, kind, address, area in (
            (0, MEM_RAM, RESET_AREA_ADDRESS, kept.reset_area),
            (1, MEM_EEPROM, EEPROM_ADDRESS, eeprom),
            (2, MEM_RAM, USER_RESERVED_ADDRESS, kept.user_reserved),
        ):
            self.mem_range_set(number, kind, address, len(area), 4, MEM_ATTR_READWRITE, area)
        self.console.write(
            f"CFE_PSP: EEPROM Range (2) created: Start Address = {EEPROM_ADDRESS:08X}, "
            f"Size = {len(eeprom):08X} Status = 0"
        )

    def _clear_memory(self) -> None:
        for area in ("CDS", "Reset", "User Reserved"):
            self.console.write(f"CFE_PSP: Clearing out CFE {area} Shared memory segment.")
        self.retained.clear()

    def _check_cds(self, offset: int, size: int) -> None:
        if offset < 0 or size < 0 or offset >= len(self.retained.cds) or offset + size > len(self.retained.cds):
            raise OsalError(CFE_PSP_ERROR, f"{size} bytes at {offset} are outside the CDS of {len(self.retained.cds)}")
