"""CFE_TIME_*: Time Services for C. A CFE_TIME_SysTime_t is one word of 64 bits: seconds below, subseconds above."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from cfepy.extra.c.crashes import CFault
from cfepy.reading.texts import to_bytes
from cfepy.status import CFE_TIME_BAD_ARGUMENT, CFE_TIME_NOT_IMPLEMENTED, CfeError

if TYPE_CHECKING:
    from cfepy.extra.c.calls import Declarations
    from cfepy.extra.c.runtime import CRuntime

BAD = CFE_TIME_BAD_ARGUMENT
Time = tuple[int, int]


def word_of(time: Time) -> int:
    """Return a time as C passes it in a register."""
    return time[0] & 0xFFFFFFFF | (time[1] & 0xFFFFFFFF) << 32


def declare(api: Declarations, c: CRuntime) -> None:
    _declare_clocks(api, c)
    _declare_arithmetic(api, c)
    _declare_signals(api, c)


def _declare_clocks(api: Declarations, c: CRuntime) -> None:
    time = c.handle.time
    for name, get in (
        ("GetTime", time.get_time),
        ("GetTAI", time.get_tai),
        ("GetUTC", time.get_utc),
        ("GetMET", time.get_met),
        ("GetSTCF", time.get_stcf),
    ):
        api.add(f"CFE_TIME_{name}", "$", _word_from(get))
    api.add("CFE_TIME_GetMETseconds", "$", time.get_met_seconds)
    api.add("CFE_TIME_GetMETsubsecs", "$", time.get_met_subsecs)
    api.add("CFE_TIME_GetLeapSeconds", "", time.get_leap_seconds)
    api.add("CFE_TIME_GetClockState", "", time.get_clock_state)
    api.add("CFE_TIME_GetClockInfo", "", time.get_clock_info)


def _word_from(get: Callable[[], Time]) -> Callable[[], int]:
    return lambda: word_of(get())


def _declare_arithmetic(api: Declarations, c: CRuntime) -> None:
    time, memory = c.handle.time, c.memory

    def print_time(buffer: int, moment: Time) -> None:
        memory.poke(buffer, to_bytes(time.print_(moment)) + b"\0")

    api.add("CFE_TIME_Add", "tt", lambda first, second: word_of(time.add(first, second)))
    api.add("CFE_TIME_Subtract", "tt", lambda first, second: word_of(time.subtract(first, second)))
    api.add("CFE_TIME_Compare", "tt", time.compare)
    api.add("CFE_TIME_MET2SCTime", "t", lambda met: word_of(time.met2sc_time(met)))
    api.add("CFE_TIME_Sub2MicroSecs", "I", time.sub2micro_secs)
    api.add("CFE_TIME_Micro2SubSecs", "I", time.micro2sub_secs)
    api.add("CFE_TIME_Print", "Pt", print_time, BAD)


def _declare_signals(api: Declarations, c: CRuntime) -> None:
    time = c.handle.time
    callbacks: dict[int, Callable[[], object]] = {}

    def callback_at(function: int) -> Callable[[], object]:
        """Return the same object for the same function, so that a registered callback can be unregistered."""
        return callbacks.setdefault(function, lambda: c.run(function))

    def only_configured(name: str, call: Callable[..., object]) -> Callable[..., object]:
        def tell(*arguments: object) -> None:
            try:
                call(*arguments)
            except CfeError as error:
                if error.status == CFE_TIME_NOT_IMPLEMENTED:  # NASA's cFE does not have the function then
                    raise CFault(f"{name}() was called: {error}") from error
                raise

        return tell

    api.add("CFE_TIME_RegisterSynchCallback", "P", lambda at: time.register_synch_callback(callback_at(at)), BAD)
    api.add("CFE_TIME_UnregisterSynchCallback", "P", lambda at: time.unregister_synch_callback(callback_at(at)), BAD)
    api.add("CFE_TIME_ExternalTone", "", time.external_tone)
    api.add("CFE_TIME_Local1HzISR", "", time.local1hz_isr)
    for name, signature, call in (
        ("CFE_TIME_ExternalMET", "t", time.external_met),
        ("CFE_TIME_ExternalGPS", "th", time.external_gps),
        ("CFE_TIME_ExternalTime", "t", time.external_time),
    ):
        api.add(name, signature, only_configured(name, call))
