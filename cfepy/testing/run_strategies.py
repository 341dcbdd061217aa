"""Hypothesis strategies for what decides a run: schedules, and what goes wrong.

They give texts and plain dictionaries, which a failing example shows as a person would write them.
"""

from __future__ import annotations

import os
from collections.abc import Iterator, Sequence
from functools import cache
from typing import Any

from hypothesis import strategies as st

from cfepy.rtos.schedule import Schedule
from cfepy.status import UsageError

DECISIONS = 500  # among which schedules deviate
HUNDREDTHS = 100  # times of faults are of 10 ms
MOST_COUNT = 20


def schedules(decisions: int = DECISIONS, *, most: int = 3, candidates: int = 3) -> st.SearchStrategy[str]:
    """Schedules that deviate from fifo in a few decisions, as `mission(schedule=...)` takes them: "at:42=1".

    They shrink to the fewest deviations, and these to the earliest.

    Args:
        decisions: how many decisions a run has, about; later ones are as fifo has them.
        most: deviations.
        candidates: how many tasks there are to choose from, at most; where there are fewer, the last one is meant.
    """
    deviations = st.dictionaries(st.integers(0, decisions - 1), st.integers(1, candidates - 1), max_size=most)
    return deviations.map(lambda chosen: Schedule().at(chosen).text() if chosen else Schedule().text())


def fault_plans(
    mission: str | os.PathLike[str] | None = None,
    *,
    messages: Sequence[str] = (),
    apps: Sequence[str] = (),
    most: int = 3,
    until: float = 10.0,
) -> st.SearchStrategy[dict[str, Any]]:
    """What may go wrong, as `mission(faults=...)` takes it: {"faults": [{"drop": "/odom", "number": 1}]}.

    They shrink to the fewest faults, and these to the first message or the earliest time.

    Args:
        mission: whose messages and applications are struck, when these are not given. It is flown once to find them.
        messages: topics, and packets by the names of the dictionary.
        apps: cFE names.
        most: faults.
        until: virtual time in s until which they happen.

    Raises:
        UsageError: there is nothing to strike.
    """
    if mission is None and not messages and not apps:
        raise UsageError("there is nothing to strike; give a mission, messages or apps")

    def made() -> st.SearchStrategy[dict[str, Any]]:
        names, own = tuple(messages), tuple(apps)
        if mission is not None and not (names or own):
            names, own = _found_in(os.fspath(mission))
        faults = st.lists(st.one_of(*_faults(names, own, until)), max_size=most)
        return faults.map(lambda chosen: {"faults": chosen})

    return st.deferred(made)


def _faults(messages: Sequence[str], apps: Sequence[str], until: float) -> Iterator[st.SearchStrategy[dict[str, Any]]]:
    """A strategy for each kind of fault."""
    when = st.integers(0, round(until * HUNDREDTHS)).map(lambda hundredths: hundredths / HUNDREDTHS)
    number = st.integers(1, MOST_COUNT)
    if messages:
        name = st.sampled_from(list(messages))
        for kind in ("drop", "duplicate", "corrupt"):
            yield st.fixed_dictionaries({kind: name, "number": number})
        delay = st.integers(1, HUNDREDTHS).map(lambda hundredths: hundredths / HUNDREDTHS)
        yield st.fixed_dictionaries({"delay": name, "number": number, "by": delay})
        yield st.fixed_dictionaries({"reorder": name, "number": number})
    if apps:
        name = st.sampled_from(list(apps))
        for kind in ("restart", "crash"):
            yield st.fixed_dictionaries({kind: name, "at": when})
        yield st.fixed_dictionaries(
            {"hang": name, "at": when, "for": st.integers(1, 10).map(lambda tenths: tenths / 10)}
        )


@cache
def _found_in(mission: str) -> tuple[tuple[str, ...], tuple[str, ...]]:
    """The messages that somebody gets in a mission, and its own applications."""
    from cfepy.mission.fault_plans import targets_of
    from cfepy.mission.spec import read_mission

    targets = targets_of(read_mission(mission))
    return tuple(name for name, _ in targets.messages), targets.apps
