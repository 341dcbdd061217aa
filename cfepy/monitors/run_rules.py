"""Rules of a mission file for a run: `invariants`, `results`, `deadlines` and `inversions`, and their monitors.

The mission stores these sections unread (`MissionSpec.demands`). The table of their readers is here; a run and
`cfepy check` report all their mistakes.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, Any

from cfepy.attachment import Attachment
from cfepy.mission import MissionSpec
from cfepy.monitors.deadlines import Deadlines, read_deadlines
from cfepy.reading.marked_yaml import Marked
from cfepy.reading.mistakes import Mistakes, collected

if TYPE_CHECKING:
    from cfepy.monitors.invariants import Invariant
    from cfepy.monitors.selected_results import SelectedResult


@dataclass(frozen=True, slots=True)
class Demands:
    """Rules of a mission file.

    Attributes:
        invariants: rules for messages.
        results: results that must not depend on the schedule.
        deadlines: time limits of applications and topics.
        inversions: minimum duration of a reported priority inversion in virtual ns; None for no search.
    """

    invariants: tuple[Invariant, ...] = ()
    results: tuple[SelectedResult, ...] = ()
    deadlines: Deadlines = field(default_factory=Deadlines)
    inversions: int | None = None


def read_demands(sections: Mapping[str, Marked], mistakes: Mistakes) -> Demands:
    """Read the sections of a mission file, without invalid entries.

    Args:
        sections: existing sections by name.
        mistakes: collects unknown keys and invalid values.
    """
    return Demands(**{name: _READERS[name](section, mistakes) for name, section in sections.items()})


def demands_of(spec: MissionSpec) -> Demands:
    """Return the rules of a mission.

    Args:
        spec: the mission.

    Raises:
        UsageError: if there is a mistake in its mission file.
    """
    return collected(partial(read_demands, spec.demands))


def judges_of(spec: MissionSpec) -> list[Attachment]:
    """Return the monitors of a mission's invariants, deadlines and priority inversions; each is loaded only if needed.

    Args:
        spec: the mission.

    Raises:
        UsageError: if there is a mistake in its mission file, or an invariant names a packet that it does not have.
    """
    demands = demands_of(spec)
    judges: list[Attachment] = []
    if demands.invariants:
        from cfepy.monitors.invariant_watch import InvariantWatch

        judges.append(InvariantWatch(spec, demands.invariants))
    if demands.deadlines:
        from cfepy.monitors.deadline_monitor import DeadlineMonitor

        judges.append(DeadlineMonitor(demands.deadlines))
    if demands.inversions is not None:
        from cfepy.monitors.inversions import InversionWatch

        judges.append(InversionWatch(demands.inversions))
    return judges


def _invariants(section: Marked, mistakes: Mistakes) -> tuple[Invariant, ...]:
    from cfepy.monitors.invariants import read_invariants

    return read_invariants(section, mistakes)


def _inversions(section: Marked, mistakes: Mistakes) -> int | None:
    return mistakes.attempt(section.time)


def _results(section: Marked, mistakes: Mistakes) -> tuple[SelectedResult, ...]:
    from cfepy.monitors.selected_results import read_selected_results

    return read_selected_results(section, mistakes)


_READERS: Mapping[str, Callable[[Marked, Mistakes], Any]] = {
    "invariants": _invariants,
    "results": _results,
    "deadlines": read_deadlines,
    "inversions": _inversions,
}
"""The reader of each section; the results are the attributes of `Demands`."""
