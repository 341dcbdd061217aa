"""The kinds of switches that a search has seen, so that it can end when schedules bring no new one.

Nearly every schedule is a new order, so the number of orders does not show that a search has seen enough. A *kind* of
switch is coarser: the task that fifo would have run, its function and the call that it makes, and the task that ran
instead. A mission has a limited number of kinds, and most of them show early.
"""

from __future__ import annotations

import sys
from zlib import crc32

from cfepy.extra.exploration.verdict import Verdict
from cfepy.rtos import Decision, NotingPolicy, Policy
from cfepy.schedules import place_at

LEAST_PATIENCE = 50  # schedules without a new kind after which a search may end
PATIENCE_SHARE = 3  # and one in so many of all schedules: a search that found something late goes on for longer


class SwitchNotingPolicy(NotingPolicy):
    """Records also the kinds of the deviations from fifo.

    Args:
        inner: the policy that decides.

    Attributes:
        switches: a number for each kind, the same one in every run and process.
    """

    def __init__(self, inner: Policy | None = None) -> None:
        super().__init__(inner)
        self.switches: set[int] = set()

    def choose(self, decision: Decision) -> int:
        choice = super().choose(decision)
        if choice:
            words = (decision.alias, place_at(decision, sys._getframe(1)), decision.alias_answers[choice])
            self.switches.add(crc32("\n".join(words).encode()))
        return choice


class SwitchKinds:
    """Counts the kinds of switches of a search.

    Attributes:
        done: number of schedules.
        last_new: number of schedules up to the last one with a new kind.
    """

    def __init__(self) -> None:
        self.done = self.last_new = 0
        self._known: set[int] = set()
        self._failures: set[str] = set()

    def take(self, verdict: Verdict) -> int:
        """Count a schedule. Returns how many new kinds it has; a new failure counts, too."""
        self.done += 1
        new = len(set(verdict.switches) - self._known) + len(set(verdict.groups) - self._failures)
        self._known.update(verdict.switches)
        self._failures.update(verdict.groups)
        if new:
            self.last_new = self.done
        return new

    @property
    def are_all_known(self) -> bool:
        """Whether so many schedules had no new kind that more of them are unlikely to have one."""
        return self.done - self.last_new >= max(LEAST_PATIENCE, self.done // PATIENCE_SHARE)

    def line(self) -> str:
        """Return a line for the user."""
        since = self.done - self.last_new
        found = f"{len(self._known)} kinds of switches (a task, its function and call, and the task that ran instead)"
        return f"{found}, no new one in the last {since} schedules" if since else found

    def to_dict(self) -> dict[str, int]:
        """Return plain data."""
        return {"kinds": len(self._known), "schedules": self.done, "last_new": self.last_new}
