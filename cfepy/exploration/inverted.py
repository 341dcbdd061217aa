"""The priority inversions that came before something went wrong: its run is flown once more, with an eye on them."""

from __future__ import annotations

from cfepy.exploration.trial import Trial
from cfepy.monitors import InversionWatch
from cfepy.rtos import Schedule

MOST_TOLD = 3


def inversions_before(trial: Trial, schedule: Schedule, at_ns: int | None, task: str = "") -> list[str]:
    """A sentence for each, the longest first; of each victim and lock only the longest.

    Args:
        trial: what is flown.
        schedule: under which it went wrong.
        at_ns: when, in virtual ns; None is the end.
        task: in which task; if that was held up like this itself, only its own are told.
    """
    watch = InversionWatch()
    trial.fly(schedule, [watch])
    before = [each for each in watch.found if at_ns is None or each.at_ns <= at_ns]
    longest = {each.group: each for each in sorted(before, key=lambda each: each.lost_ns)}
    told = [each for each in longest.values() if each.victim == task] or list(longest.values())
    return [each.text for each in reversed(told)][:MOST_TOLD]
