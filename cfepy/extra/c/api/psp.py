"""CFE_PSP_*: the board for C, except its memory (`psp_memory`) and its drivers (`psp_iodriver`).

CFE_PSP_Main can be found by its name, as on a board; it runs there before there are applications.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.extra.c.crashes import CFault
from cfepy.psp import PanicError
from cfepy.reading.texts import to_bytes
from cfepy.status import CFE_PSP_ERROR, CFE_PSP_INVALID_POINTER, OsalError

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

SIZES = ((16, "H"), (32, "I"), (64, "Q"))
"""Bits of the numbers whose byte order can be swapped, and their letter in a signature."""


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_resets(api, c)
    _declare_watchdog(api, c)
    _declare_identity(api, c)
    _declare_time(api, c)
    _declare_exceptions(api, c)
    _declare_cds(api, c)
    _declare_byte_order(api, c)
    _declare_rest(api, c)


def _declare_resets(api: Declarations, c: CRuntime) -> None:
    psp = c.handle.psp

    def main() -> None:
        raise CFault("CFE_PSP_Main() must not be called by an application; the board calls it")

    def panic(code: int) -> None:
        try:
            psp.panic(code)
        except PanicError as error:
            c.raise_through(error)

    def restart_type(subtype: int) -> int:
        kind = psp.get_restart_type()
        if subtype:
            c.memory.put_u32(subtype, kind.subtype)
        return kind.reset_type

    api.add("CFE_PSP_Main", "", main)
    api.add("CFE_PSP_Restart", "I", psp.restart)
    api.add("CFE_PSP_GetRestartType", "p", restart_type)
    api.add("CFE_PSP_Panic", "i", panic)


def _declare_watchdog(api: Declarations, c: CRuntime) -> None:
    psp = c.handle.psp
    api.add("CFE_PSP_WatchdogInit", "", psp.watchdog_init)
    api.add("CFE_PSP_WatchdogEnable", "", psp.watchdog_enable)
    api.add("CFE_PSP_WatchdogDisable", "", psp.watchdog_disable)
    api.add("CFE_PSP_WatchdogService", "", psp.watchdog_service)
    api.add("CFE_PSP_WatchdogGet", "", psp.watchdog_get)
    api.add("CFE_PSP_WatchdogSet", "I", psp.watchdog_set)


def _declare_identity(api: Declarations, c: CRuntime) -> None:
    psp, text = c.handle.psp, c.constants.text

    def version_number(at: int) -> None:
        if at:
            c.memory.poke(at, bytes(psp.get_version_number()))

    def status_to_string(status: int, at: int) -> int:
        if at:
            c.memory.poke(at, psp.status_to_string(status).encode() + b"\0")
        return at

    api.add("CFE_PSP_GetProcessorId", "", psp.get_processor_id)
    api.add("CFE_PSP_GetSpacecraftId", "", psp.get_spacecraft_id)
    api.add("CFE_PSP_GetProcessorName", "", lambda: text(psp.get_processor_name()))
    api.add("CFE_PSP_GetVersionString", "", lambda: text(psp.get_version_string()))
    api.add("CFE_PSP_GetVersionCodeName", "", lambda: text(psp.get_version_code_name()))
    api.add("CFE_PSP_GetVersionNumber", "p", version_number)
    api.add("CFE_PSP_GetBuildNumber", "", psp.get_build_number)
    api.add("CFE_PSP_StatusToString", "ip", status_to_string)


def _declare_time(api: Declarations, c: CRuntime) -> None:
    """Add functions for the clock. Code may wait by reading a clock repeatedly, so each reading costs virtual time."""
    psp = c.handle.psp
    api.add("CFE_PSP_GetTime", "$8", psp.get_time)
    api.add("CFE_PSP_Get_Timebase", "$44", psp.get_timebase)
    api.add("CFE_PSP_GetTimerTicksPerSecond", "", psp.get_timer_ticks_per_second)
    api.add("CFE_PSP_GetTimerLow32Rollover", "", psp.get_timer_low32_rollover)


def _declare_exceptions(api: Declarations, c: CRuntime) -> None:
    psp, memory = c.handle.psp, c.memory

    def summary(context_id: int, task_id: int, reason: int, size: int) -> None:
        found = psp.exception_get_summary()
        if context_id:
            memory.put_u32(context_id, found.context_id)
        if task_id:
            memory.put_u32(task_id, found.task_id)
        if reason and size:
            memory.poke(reason, to_bytes(found.reason)[: size - 1] + b"\0")

    def copy_context(context_id: int, buffer: int, size: int) -> int:
        context = psp.exception_copy_context(context_id, size)
        memory.poke(buffer, context)
        return len(context)

    api.add("CFE_PSP_AttachExceptions", "", psp.attach_exceptions)
    api.add("CFE_PSP_SetDefaultExceptionEnvironment", "", psp.set_default_exception_environment)
    api.add("CFE_PSP_Exception_GetCount", "", psp.exception_get_count)
    api.add("CFE_PSP_Exception_GetSummary", "pppI", summary)
    api.add("CFE_PSP_Exception_CopyContext", "IPI", copy_context, CFE_PSP_INVALID_POINTER)


def _declare_cds(api: Declarations, c: CRuntime) -> None:
    psp, memory = c.handle.psp, c.memory

    def write(data: int, offset: int, size: int) -> None:
        _check_cds(offset, size, psp.get_cds_size())
        psp.write_to_cds(memory.peek(data, size), offset)

    def read(data: int, offset: int, size: int) -> None:
        memory.poke(data, psp.read_from_cds(offset, size))

    api.add("CFE_PSP_GetCDSSize", "4", psp.get_cds_size, CFE_PSP_ERROR)
    api.add("CFE_PSP_WriteToCDS", "PII", write, CFE_PSP_ERROR)
    api.add("CFE_PSP_ReadFromCDS", "PII", read, CFE_PSP_ERROR)


def _check_cds(offset: int, size: int, room: int) -> None:
    """Check a size before C's memory is read, because memory of an invalid size may not exist."""
    if offset + size > room:
        raise OsalError(CFE_PSP_ERROR, f"{size} bytes at {offset} are outside the CDS of {room}")


def _declare_byte_order(api: Declarations, c: CRuntime) -> None:
    psp = c.handle.psp
    for bits, letter in SIZES:
        for order, swap in (("BE", getattr(psp, f"hto_be{bits}")), ("LE", getattr(psp, f"hto_le{bits}"))):
            api.add(f"CFE_PSP_Hto{order}{bits}", letter, swap)
            api.add(f"CFE_PSP_{order}{bits}toH", letter, swap)
    api.add("CFE_PSP_IsBigEndian", "", psp.is_big_endian)
    api.add("CFE_PSP_IsLittleEndian", "", psp.is_little_endian)


def _declare_rest(api: Declarations, c: CRuntime) -> None:
    psp = c.handle.psp

    def init_ssr(bus: int, device: int, name: str | None) -> None:
        psp.init_ssr(bus, device, name or "")

    api.add("CFE_PSP_FlushCaches", "IpI", psp.flush_caches)
    api.add("CFE_PSP_InitSSR", "IIs", init_ssr)
