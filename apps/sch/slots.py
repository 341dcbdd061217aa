"""Calculation of the slots that are due after waking up too early, too late, or far behind (sch_app.c).

The functions are pure. `current` is the slot of the current time, `following` the one that would be done next; both
range from 0 to SLOTS - 1.
"""

from __future__ import annotations

from typing import NamedTuple

from .packets import SLOTS

MAX_LAG = SLOTS // 2
"""More slots behind than this are skipped (SCH_MAX_LAG_COUNT)."""

MAX_PER_WAKEUP = 5
"""Those that are behind are not done all at once (SCH_MAX_SLOTS_PER_WAKEUP)."""


class Due(NamedTuple):
    """The work of a wake-up: `todo` slots. `behind` is the clock's difference, for the next wake-up.

    With `same` the slot did not advance. With `skipped` that many slots are left out, and only the current one is done.
    """

    todo: int
    behind: int
    same: bool = False
    skipped: int = 0


def due(current: int, following: int, behind_before: int) -> Due:
    """Return how many slots a wake-up has to do.

    A timer that is slightly late once makes two slots due, then none. One that is slightly early makes none due, then
    two. So one slot is done if two are due after a wake-up with one, and if none is due after a wake-up with some.

    Args:
        current: the slot of the current time.
        following: the slot after the last that was done.
        behind_before: `Due.behind` of the wake-up before.
    """
    behind = (current - following) % SLOTS + 1
    count = behind
    if (behind == 2 and behind_before == 1) or (behind == SLOTS and behind_before != SLOTS):
        count = 1
    if count == SLOTS:
        return Due(0, behind, same=True)
    if count > MAX_LAG:
        return Due(1, behind, skipped=count - 1)
    return Due(min(count, MAX_PER_WAKEUP), behind)


def is_due(second: int, frequency: int, remainder: int) -> bool:
    """Return whether an activity happens in this pass of the table."""
    return second % frequency == remainder


def slot_of_us(microseconds: int, period_us: int) -> int:
    """Return the slot of a time within a second. One microsecond before a slot already counts as the slot."""
    return (microseconds + 1) // period_us % SLOTS
