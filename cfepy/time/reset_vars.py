"""The values that outlive a processor reset: MET, STCF, tone delay, leap seconds and tone signal, in C's byte layout.

It replaces CFE_TIME_QueryResetVars and CFE_TIME_UpdateResetVars.
"""

from __future__ import annotations

from typing import Any

from cfepy.time.clock import SpacecraftTime
from cfepy.time.packets import RESET_VARS
from cfepy.time.settings import TimeSettings
from cfepy.time.systime import fields_of, ticks_of
from cfepy.time.tone import SIGNAL_PRIMARY, SIGNAL_REDUNDANT, Tone

KEPT = "TIME"
"""The key of these 32 bytes among the objects that outlive a processor reset."""

SIGNATURE = 0xA5A55A5A
RESET_AREA_NEW, RESET_AREA_EXISTING = 3, 4
"""The source of the start values (DataStoreStatus of the diagnostic packet)."""


def start(kept: dict[str, Any], clock: SpacecraftTime, tone: Tone, settings: TimeSettings) -> int:
    """Set the clock to the kept values, or to the configured values if these are missing or invalid.

    Args:
        kept: objects that outlive a processor reset.
        clock: the clock to set.
        tone: gets the tone signal.
        settings: the configured values.

    Returns:
        RESET_AREA_EXISTING or RESET_AREA_NEW.
    """
    saved = RESET_VARS.unpack(kept.get(KEPT, bytes(RESET_VARS.size)))
    if saved["Signature"] != SIGNATURE or saved["ClockSignal"] not in (SIGNAL_PRIMARY, SIGNAL_REDUNDANT):
        clock.update(met=settings.default_met, stcf=settings.default_stcf, leap_seconds=settings.default_leap_seconds)
        return RESET_AREA_NEW
    tone.signal = saved["ClockSignal"]
    met, stcf, delay = (ticks_of(saved[name]) for name in ("CurrentMET", "CurrentSTCF", "CurrentDelay"))
    clock.update(met=met, stcf=stcf, delay=delay, leap_seconds=saved["LeapSeconds"])
    return RESET_AREA_EXISTING


def save(kept: dict[str, Any], clock: SpacecraftTime, tone: Tone) -> None:
    """Save the present values. The delay of the tone is separate, and NASA's TIME has it in MET as well."""
    reference = clock.reference
    met = reference.met + clock.since_tone() if tone.settings.safe else clock.current_met()
    kept[KEPT] = RESET_VARS.pack(
        Signature=SIGNATURE,
        LeapSeconds=reference.leap_seconds,
        ClockSignal=tone.signal,
        CurrentMET=fields_of(met),
        CurrentSTCF=fields_of(reference.stcf),
        CurrentDelay=fields_of(reference.delay),
    )
