"""The configuration of Time Services: server or client, the sources of tone and time, and the limits.

It replaces cfe_time_verify.h and the constants that CFE_TIME_InitData computes.
"""

from __future__ import annotations

from dataclasses import dataclass

from cfepy.config.platform import PlatformConfig
from cfepy.status import UsageError
from cfepy.time.systime import SysTime, micro2sub_secs, to_ticks
from cfepy.units import US_PER_S

SOURCES = ("met", "gps", "time")


@dataclass(frozen=True, slots=True)
class TimeSettings:
    """The configuration; times and limits are in ticks of 2**-32 s, except whole seconds.

    `client` follows a server's time instead of keeping one. `fake_tone` makes tones from the local 1 Hz signal.
    `will_be` means that a message has the time of the next tone, not of the last one. `utc` makes UTC the spacecraft
    time. `can_select_signal` and `can_select_source` allow the two commands. `external` is the kind of external source:
    "met", "gps", "time", or "" if there is none. `safe` adds the delay of the tone once; NASA's TIME adds it again at a
    reset and each time that it moves the reference in flywheel mode.
    """

    client: bool
    fake_tone: bool
    will_be: bool
    utc: bool
    can_select_signal: bool
    can_select_source: bool
    external: str
    default_met: int
    default_stcf: int
    default_leap_seconds: int
    min_elapsed: int
    max_elapsed: int
    max_delta: SysTime
    max_local: SysTime
    tone_over_limit: int
    tone_under_limit: int
    start_fly_secs: int
    latch_fly_secs: int
    safe: bool

    @classmethod
    def of(cls, config: PlatformConfig) -> TimeSettings:
        """Return the settings of a platform configuration.

        Raises:
            UsageError: if they contradict each other.
        """
        external = [source for source in SOURCES if getattr(config, f"time_cfg_src_{source}")]
        _check(config, external)
        return cls(
            client=config.time_cfg_client,
            safe=config.safe,
            fake_tone=config.time_cfg_fake_tone,
            will_be=config.time_at_tone_will_be,
            utc=config.time_cfg_default_utc,
            can_select_signal=config.time_cfg_signal,
            can_select_source=config.time_cfg_source,
            external="".join(external),
            default_met=to_ticks((config.time_def_met_secs, micro2sub_secs(config.time_def_met_subs))),
            default_stcf=to_ticks((config.time_def_stcf_secs, micro2sub_secs(config.time_def_stcf_subs))),
            default_leap_seconds=config.time_def_leaps,
            min_elapsed=micro2sub_secs(config.time_min_elapsed),
            max_elapsed=micro2sub_secs(config.time_max_elapsed),
            max_delta=SysTime(config.time_max_delta_secs, micro2sub_secs(config.time_max_delta_subs)),
            max_local=SysTime(config.time_max_local_secs, config.time_max_local_subs),
            tone_over_limit=micro2sub_secs(config.time_cfg_tone_limit),
            tone_under_limit=micro2sub_secs(US_PER_S - config.time_cfg_tone_limit),
            start_fly_secs=config.time_cfg_start_fly,
            latch_fly_secs=config.time_cfg_latch_fly,
        )


def _check(config: PlatformConfig, external: list[str]) -> None:
    for is_wrong, field, text in (
        (config.time_cfg_client and config.time_cfg_source, "client", "a client has no source of its own"),
        (bool(external) and not config.time_cfg_source, f"src_{''.join(external[:1])}", "needs time_cfg_source"),
        (config.time_cfg_source and len(external) != 1, "source", "needs exactly one of time_cfg_src_met, _gps, _time"),
        (config.time_cfg_fake_tone and config.time_cfg_source, "source", "needs time_cfg_fake_tone: false"),
        (
            config.time_cfg_fake_tone and config.time_at_tone_will_be,
            "fake_tone",
            "a simulated tone cannot be foretold: time_at_tone_will_be",
        ),
    ):
        if is_wrong:
            raise UsageError(text, field=f"limits.time_cfg_{field}")
