"""Which slots are to be done: the arithmetic of waking up too early, too late, or far behind (sch_app.c).

Pure functions of numbers. `current` is the slot that the time says, `following` the one that would be done next; both
go from 0 to SLOTS - 1.
"""

from __future__ import annotations

from typing import NamedTuple

from .packets import SLOTS

MAX_LAG = SLOTS // 2
"""More slots behind than this are skipped (SCH_MAX_LAG_COUNT)."""

MAX_PER_WAKEUP = 5
"""Those that are behind are not done all at once (SCH_MAX_SLOTS_PER_WAKEUP)."""


class Due(NamedTuple):
    """What a wake-up has to do: `todo` slots; `behind` is what the clock made of it, for the next wake-up.

    With `same` the slot did not advance; with `skipped` so many slots are left out, and the current one is done alone.
    """

    todo: int
    behind: int
    same: bool = False
    skipped: int = 0


def due(current: int, following: int, behind_before: int) -> Due:
    """How many slots a wake-up has to do.

    A timer that is a little late once makes two slots due, then none; one that is a little early none, then two. So one
    slot is done where two are due after a wake-up with one, and where none is due after a wake-up with some.

    Args:
        current: the slot that it is.
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
    """Whether an activity happens in this pass of the table."""
    return second % frequency == remainder


def slot_of_us(microseconds: int, period_us: int) -> int:
    """The slot of a time within a second; a microsecond before its begin is near enough."""
    return (microseconds + 1) // period_us % SLOTS
