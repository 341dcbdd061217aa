"""The field `epoch:` of the mission file: the date at which the flight computer is switched on.

Spacecraft time counts from 1980-01-01. As UTC it counts the seconds of a calendar, without leap seconds. TAI is UTC
plus the leap seconds of Time Services, so it is 37 s ahead by default. The date becomes the default STCF, as in a
build of cFE with other values of CFE_MISSION_TIME_DEF_STCF_SECS and _SUBS:

    UTC = MET + STCF - leap seconds

ROS time is UTC. A mission without the field has the time of cFE's defaults, with ROS time equal to the spacecraft time.
"""

from __future__ import annotations

import re
from calendar import monthrange, timegm

from cfepy.config.platform import PlatformConfig
from cfepy.reading.marked_yaml import Marked
from cfepy.status import UsageError
from cfepy.units import NS_PER_S, NS_PER_US, US_PER_S

EARLIEST, LATEST = 1980, 2105
"""Years of an epoch: spacecraft time begins in 1980, and the seconds of ROS 1 end in February 2106."""

STCF_LIMITS = ("time_def_stcf_secs", "time_def_stcf_subs")
"""The limits that an epoch decides."""

_EXPECTED = "must be a date such as 2026-05-01T12:00:00Z"
_ISO_8601 = re.compile(
    r"(?P<year>\d{4})-(?P<month>\d\d)-(?P<day>\d\d)"
    r"([Tt ](?P<hour>\d\d):(?P<minute>\d\d)(:(?P<second>\d\d)(\.(?P<fraction>\d{1,9}))?)?"
    r" ?(Z|z|(?P<sign>[+-])(?P<zone_hour>\d\d)(:?(?P<zone_minute>\d\d))?)?)?"
)


def read_epoch(entry: Marked) -> int:
    """Return a date as Unix time in ns; a date without a zone is UTC, and one without a time is midnight.

    Args:
        entry: the date, which YAML has read, or a text.

    Raises:
        UsageError: if it is not a date, or is outside the years of an epoch.
    """
    value = entry.value if isinstance(entry.value, str) else getattr(entry.value, "isoformat", str)()
    found = _ISO_8601.fullmatch(value)
    if found is None:
        raise entry.fail(f"{_EXPECTED}, not {entry.shown()}")
    numbers = {name: int(text or 0) for name, text in found.groupdict().items() if name not in ("sign", "fraction")}
    _check(numbers, entry)
    zone_s = (numbers["zone_hour"] * 60 + numbers["zone_minute"]) * 60 * (-1 if found["sign"] == "-" else 1)
    utc_s = timegm(tuple(numbers[name] for name in ("year", "month", "day", "hour", "minute", "second"))) - zone_s
    if not timegm((EARLIEST, 1, 1, 0, 0, 0)) <= utc_s < timegm((LATEST + 1, 1, 1, 0, 0, 0)):
        raise entry.fail(f"must be in the years {EARLIEST} to {LATEST}, not {entry.shown()}")
    return utc_s * NS_PER_S + int((found["fraction"] or "").ljust(9, "0")) // NS_PER_US * NS_PER_US


def _check(numbers: dict[str, int], entry: Marked) -> None:
    """Raise the error about a number outside its range; the range of days depends on the month."""
    year, month = numbers["year"], numbers["month"]
    days = monthrange(year, month)[1] if 1 <= month <= 12 else 31
    ranges = {"year": (1, 9999), "month": (1, 12), "day": (1, days), "hour": (0, 23), "minute": (0, 59)}
    ranges |= {"second": (0, 59), "zone_hour": (0, 23), "zone_minute": (0, 59)}
    for name, (lowest, highest) in ranges.items():
        if not lowest <= numbers[name] <= highest:
            raise entry.fail(f"{_EXPECTED}, not {entry.shown()}: the {name} must be {lowest} to {highest}")


def refuse_both(epoch: Marked, limits: Marked) -> UsageError | None:
    """Return the error if a mission file has an epoch and also sets the STCF that follows from it; None if not."""
    both = [name for name in STCF_LIMITS if isinstance(limits.value, dict) and name in limits.value]
    return epoch.fail(f"cannot be combined with limits.{both[0]}; remove one") if both else None


def starting_at(config: PlatformConfig, epoch_ns: int, unix_at_zero_s: int) -> PlatformConfig:
    """Return a configuration whose default STCF makes UTC a date when the computer is switched on.

    Args:
        config: has MET and leap seconds at that instant.
        epoch_ns: the date as Unix time in ns.
        unix_at_zero_s: Unix time in s when the spacecraft's UTC is 0.
    """
    utc_us = epoch_ns // NS_PER_US - unix_at_zero_s * US_PER_S
    met_us = config.time_def_met_secs * US_PER_S + config.time_def_met_subs
    seconds, micros = divmod(utc_us + config.time_def_leaps * US_PER_S - met_us, US_PER_S)
    return config.with_limits(dict(zip(STCF_LIMITS, (seconds % (1 << 32), micros), strict=True)))
