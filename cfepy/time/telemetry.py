"""The housekeeping and diagnostic packets of Time Services (CFE_TIME_GetHkData, CFE_TIME_GetDiagData)."""

from __future__ import annotations

from collections.abc import Mapping

from cfepy.core_app import Replies
from cfepy.msg import sys_time_fields
from cfepy.time.clock import ADD, SpacecraftTime
from cfepy.time.systime import MASK_32, fields_of
from cfepy.time.tone import SIGNAL_PRIMARY, SOURCE_INTERNAL, Tone

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
FLAG_REFERR = 0x0010
"""Clock state flags (CFE_TIME_FLAG_*)."""


def clock_info(clock: SpacecraftTime, tone: Tone) -> int:
    """Return the clock state flags (CFE_TIME_GetClockInfo); FLAG_REFERR is never set, because a reference is always
    consistent.
    """
    reference = clock.reference
    flags = 0
    for is_set, flag in (
        (reference.was_set, FLAG_CLKSET),
        (reference.flying, FLAG_FLYING),
        (tone.source == SOURCE_INTERNAL, FLAG_SRCINT),
        (tone.signal == SIGNAL_PRIMARY, FLAG_SIGPRI),
        (clock.server_flying, FLAG_SRVFLY),
        (tone.forced_to_fly, FLAG_CMDFLY),
        (tone.adjustments.one_time_direction == ADD, FLAG_ADDADJ),
        (tone.adjustments.one_hz_direction == ADD, FLAG_ADD1HZ),
        (reference.delay_direction == ADD, FLAG_ADDTCL),
        (not tone.settings.client, FLAG_SERVER),
        (tone.good, FLAG_GDTONE),
    ):
        if is_set:
            flags |= flag
    return flags


def housekeeping(clock: SpacecraftTime, tone: Tone, replies: Replies) -> Mapping[str, object]:
    """Return the fields of the housekeeping packet; 8-bit counters wrap.

    Args:
        clock: the clock.
        tone: the tone.
        replies: the command counters.
    """
    reference = clock.reference
    return {
        "CommandCounter": replies.command_counter & 0xFF,
        "CommandErrorCounter": replies.error_counter & 0xFF,
        "ClockStateFlags": clock_info(clock, tone),
        "ClockStateAPI": clock.state(),
        "LeapSeconds": reference.leap_seconds,
        "MET": fields_of(clock.current_met()),
        "STCF": fields_of(reference.stcf),
        "AdjustmentFactor": fields_of(reference.delay if tone.settings.client else tone.adjustments.one_hz),
    }


def diagnostic(clock: SpacecraftTime, tone: Tone, version_at_reset: int, data_store: int) -> Mapping[str, object]:
    """Return the fields of the diagnostic packet.

    Args:
        clock: the clock.
        tone: the tone.
        version_at_reset: `clock.version` when the counters were reset.
        data_store: the source of the start values (cfepy.time.reset_vars).
    """
    settings = tone.settings
    return {
        **_times(clock, tone),
        **_states(clock, tone),
        **_counts(tone),
        "VersionCounter": clock.version - version_at_reset & MASK_32,
        "VirtualMET": tone.virtual_met,
        "MinElapsed": settings.min_elapsed,
        "MaxElapsed": settings.max_elapsed,
        "MaxLocalClock": sys_time_fields(settings.max_local),
        "ToneOverLimit": settings.tone_over_limit,
        "ToneUnderLimit": settings.tone_under_limit,
        "DataStoreStatus": data_store,
    }


def _times(clock: SpacecraftTime, tone: Tone) -> dict[str, object]:
    reference = clock.reference
    times = {
        "AtToneMET": reference.met,
        "AtToneSTCF": reference.stcf,
        "AtToneDelay": reference.delay,
        "AtToneLatch": reference.latch,
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
    reference = clock.reference
    return {
        "AtToneLeapSeconds": reference.leap_seconds,
        "ClockStateAPI": clock.state(),
        "ClockSetState": int(reference.was_set),
        "ClockFlyState": int(reference.flying),
        "ClockSource": tone.source,
        "ClockSignal": tone.signal,
        "ServerFlyState": int(clock.server_flying),
        "Forced2Fly": int(tone.forced_to_fly),
        "ClockStateFlags": clock_info(clock, tone),
        "OneTimeDirection": tone.adjustments.one_time_direction,
        "OneHzDirection": tone.adjustments.one_hz_direction,
        "DelayDirection": reference.delay_direction,
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
