"""The ratios between units of time; cfepy keeps all times in nanoseconds."""

from __future__ import annotations

PS_PER_NS = 1_000
NS_PER_US = 1_000
NS_PER_MS = 1_000_000
NS_PER_S = 1_000_000_000
US_PER_S = 1_000_000

TIME_UNITS = {"ns": 1, "us": NS_PER_US, "ms": NS_PER_MS, "s": NS_PER_S}
"""The ns in each unit of time, by the suffix after a number; the smallest unit comes first."""


def time_word(time_ns: int) -> str:
    """Return a time as a whole number of the largest unit that divides it, such as 25ms; 0 gives 0s."""
    unit, size = next((unit, size) for unit, size in reversed(TIME_UNITS.items()) if time_ns % size == 0)
    return f"{time_ns // size}{unit}"


def instant_text(at_ns: int) -> str:
    """Return the virtual time of a failure or another event, in seconds to the microsecond: "1.100024 s"."""
    return f"{at_ns / NS_PER_S:.6f} s"


def time_text(duration_ns: int) -> str:
    """Return a time with its unit, such as "2.5 ms"."""
    unit = next((name for name in ("s", "ms", "us") if duration_ns >= TIME_UNITS[name]), "ns")
    return f"{duration_ns / TIME_UNITS[unit]:.6g} {unit}"
