"""The housekeeping and diagnostic packets of Time Services (CFE_TIME_GetHkData, CFE_TIME_GetDiagData)."""

from __future__ import annotations

from collections.abc import Mapping

from cfepy.time import tone as tn
from cfepy.time.clock import SpacecraftTime
from cfepy.time.systime import MASK_32, from_ticks
from cfepy.time.tone import Tone

FLAG_CLKSET = 0x8000
FLAG_FLYING = 0x4000
FLAG_SRCINT = 0x2000
FLAG_SIGPRI = 0x1000
FLAG_SRVFLY = 0x0800
FLAG_CMDFLY = 0x0400
FLAG_ADDADJ = 0x0200
FLAG_ADD1HZ = 0x0100
FLAG_ADDTCL = 0x0080
FLAG_SERVER = 0x0040
FLAG_GDTONE = 0x0020
"""Clock state flags (CFE_TIME_FLAG_*)."""

SOURCE_INTERNAL = 1
SIGNAL_PRIMARY = 1
MAX_LOCAL_CLOCK = (27, 0)
"""CFE_PLATFORM_TIME_MAX_LOCAL_SECS, _SUBS; reported only, the simulated clock never rolls over."""

RESET_AREA_NEW, RESET_AREA_EXISTING = 3, 4
"""Where the start values came from (DataStoreStatus)."""


def clock_info(clock: SpacecraftTime, tone: Tone) -> int:
    """The clock state flags (CFE_TIME_GetClockInfo)."""
    flags = FLAG_SRCINT | FLAG_SIGPRI | FLAG_ADDTCL | FLAG_SERVER
    for is_set, flag in (
        (clock.was_set, FLAG_CLKSET),
        (clock.flying, FLAG_FLYING),
        (tone.server_flying, FLAG_SRVFLY),
        (tone.forced_to_fly, FLAG_CMDFLY),
        (tone.adjustments.one_time_direction == tn.ADD, FLAG_ADDADJ),
        (tone.adjustments.one_hz_direction == tn.ADD, FLAG_ADD1HZ),
        (tone.good, FLAG_GDTONE),
    ):
        if is_set:
            flags |= flag
    return flags


def fields_of(ticks: int) -> dict[str, int]:
    """A time as the fields of CFE_TIME_SysTime_t."""
    time = from_ticks(ticks)
    return {"Seconds": time.seconds, "Subseconds": time.subseconds}


def housekeeping(clock: SpacecraftTime, tone: Tone, commands: int, errors: int) -> Mapping[str, object]:
    """Fields of the housekeeping packet; 8-bit counters wrap.

    Args:
        clock: the clock.
        tone: the tone.
        commands: command counter.
        errors: command error counter.
    """
    return {
        "CommandCounter": commands & 0xFF,
        "CommandErrorCounter": errors & 0xFF,
        "ClockStateFlags": clock_info(clock, tone),
        "ClockStateAPI": clock.state(),
        "LeapSeconds": clock.leap_seconds,
        "MET": fields_of(clock.current_met()),
        "STCF": fields_of(clock.stcf),
        "AdjustmentFactor": fields_of(tone.adjustments.one_hz),
    }


def diagnostic(clock: SpacecraftTime, tone: Tone, version_at_reset: int, reset_area: int) -> Mapping[str, object]:
    """Fields of the diagnostic packet.

    Args:
        clock: the clock.
        tone: the tone.
        version_at_reset: `clock.version` when counters were reset.
        reset_area: RESET_AREA_NEW or RESET_AREA_EXISTING.
    """
    return {
        **_times(clock, tone),
        **_states(clock, tone),
        **_counts(tone),
        "VersionCounter": clock.version - version_at_reset & MASK_32,
        "VirtualMET": tone.virtual_met,
        "MinElapsed": tn.MIN_ELAPSED,
        "MaxElapsed": tn.MAX_ELAPSED,
        "MaxLocalClock": {"Seconds": MAX_LOCAL_CLOCK[0], "Subseconds": MAX_LOCAL_CLOCK[1]},
        "ToneOverLimit": tn.TONE_OVER_LIMIT,
        "ToneUnderLimit": tn.TONE_UNDER_LIMIT,
        "DataStoreStatus": reset_area,
    }


def _times(clock: SpacecraftTime, tone: Tone) -> dict[str, object]:
    times = {
        "AtToneMET": clock.met,
        "AtToneSTCF": clock.stcf,
        "AtToneDelay": clock.delay,
        "AtToneLatch": clock.latch,
        "TimeSinceTone": clock.since_tone(),
        "CurrentLatch": clock.local(),
        "CurrentMET": clock.current_met(),
        "CurrentTAI": clock.current_tai(),
        "CurrentUTC": clock.current_utc(),
        "OneTimeAdjust": tone.adjustments.one_time,
        "OneHzAdjust": tone.adjustments.one_hz,
        "ToneSignalLatch": tone.signal_latch,
        "ToneDataLatch": tone.data_latch,
    }
    return {name: fields_of(ticks) for name, ticks in times.items()}


def _states(clock: SpacecraftTime, tone: Tone) -> dict[str, object]:
    return {
        "AtToneLeapSeconds": clock.leap_seconds,
        "ClockStateAPI": clock.state(),
        "ClockSetState": int(clock.was_set),
        "ClockFlyState": int(clock.flying),
        "ClockSource": SOURCE_INTERNAL,
        "ClockSignal": SIGNAL_PRIMARY,
        "ServerFlyState": int(tone.server_flying),
        "Forced2Fly": int(tone.forced_to_fly),
        "ClockStateFlags": clock_info(clock, tone),
        "OneTimeDirection": tone.adjustments.one_time_direction,
        "OneHzDirection": tone.adjustments.one_hz_direction,
        "DelayDirection": tn.ADD,
    }


def _counts(tone: Tone) -> dict[str, object]:
    counters = tone.counters
    return {
        "ToneMatchCounter": counters.tone_match & MASK_32,
        "ToneMatchErrorCounter": counters.tone_match_error & MASK_32,
        "ToneSignalCounter": counters.tone_signal & MASK_32,
        "ToneDataCounter": counters.tone_data & MASK_32,
        "ToneIntCounter": counters.tone_interrupt & MASK_32,
        "ToneIntErrorCounter": counters.tone_interrupt_error & MASK_32,
        "ToneTaskCounter": counters.tone_task & MASK_32,
        "LocalIntCounter": counters.local_interrupt & MASK_32,
        "LocalTaskCounter": counters.local_task & MASK_32,
    }
