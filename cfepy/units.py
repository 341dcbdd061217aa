"""How the units of time relate; all times here are in nanoseconds."""

from __future__ import annotations

PS_PER_NS = 1_000
NS_PER_US = 1_000
NS_PER_MS = 1_000_000
NS_PER_S = 1_000_000_000
US_PER_S = 1_000_000

TIME_UNITS = {"ns": 1, "us": NS_PER_US, "ms": NS_PER_MS, "s": NS_PER_S}
"""How many ns each unit of time has, by the name that is written behind a number; the smallest comes first."""


def time_word(time_ns: int) -> str:
    """A time as a whole number of the largest unit that it has, such as 25ms; 0 is 0s."""
    unit, size = next((unit, size) for unit, size in reversed(TIME_UNITS.items()) if time_ns % size == 0)
    return f"{time_ns // size}{unit}"


def time_text(duration_ns: int) -> str:
    """A time as people write it: "2.5 ms"."""
    unit = next((name for name in ("s", "ms", "us") if duration_ns >= TIME_UNITS[name]), "ns")
    return f"{duration_ns / TIME_UNITS[unit]:.6g} {unit}"
