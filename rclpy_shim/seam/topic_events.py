"""Events of the two sides of a topic (rcl_event_t): matches, unequal qualities, missed deadlines, lost liveliness.

A status counts, and is ready when its numbers have changed. Deadlines and liveliness need no timer: an executor looks
at `due_ns` of each event with a callback.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

NEVER = 1 << 62
ALIVE, NOT_ALIVE = True, False
POLICIES = {"DURABILITY": 2, "DEADLINE": 4, "LIVELINESS": 8, "RELIABILITY": 16}
"""Numbers of policies (rmw_qos_policy_kind_t)."""


class Status:
    """Numbers of one kind of event.

    Args:
        names: names of the numbers; each but the last policy has another one with its change since the last look.
        on_change: called when the numbers change.
    """

    def __init__(self, names: tuple[str, ...], on_change: Callable[[], object]) -> None:
        self.values = {name: 0 for each in names for name in (each, f"{each}_change")}
        self.is_new = False
        self._on_change = on_change

    def add(self, name: str, number: int) -> None:
        """Add to a number, and to its change."""
        self.values[name] += number
        self.values[f"{name}_change"] += number
        self.is_new = True
        self._on_change()

    def settle(self) -> None:
        """Count the events up to now."""

    def is_waiting(self) -> bool:
        """Return True if the numbers may change by the passing of time alone, or have changed."""
        return self.is_new

    def ready(self) -> bool:
        """Return True if the numbers have changed since the last look."""
        self.settle()
        return self.is_new

    @property
    def due_ns(self) -> int:
        """The steady time in ns at which the numbers will change; far away if nothing is due."""
        return NEVER

    def take(self) -> dict[str, int]:
        """Return the numbers, and begin to count changes anew."""
        found = dict(self.values)
        self.values.update({name: 0 for name in found if name.endswith("_change")})
        self.is_new = False
        return found


class Incompatible(Status):
    """Counts other sides with an unequal quality of service."""

    def __init__(self, on_change: Callable[[], object]) -> None:
        super().__init__(("total_count",), on_change)
        self.values["last_policy_kind"] = 1

    def note(self, policy: str) -> None:
        """Count another side, by the name of the policy that keeps it apart."""
        self.values["last_policy_kind"] = POLICIES[policy]
        self.add("total_count", 1)


class Matched(Status):
    """Counts connected other sides."""

    def __init__(self, on_change: Callable[[], object]) -> None:
        super().__init__(("total_count", "current_count"), on_change)

    def note(self, count: int) -> None:
        """Note the present number of connected sides."""
        change = count - self.values["current_count"]
        if change > 0:
            self.add("total_count", change)
        if change:
            self.add("current_count", change)


class Deadline(Status):
    """Counts the periods without a message since the first one.

    Args:
        on_change: called when the numbers change.
        period_ns: the longest time between two messages; 0 for no limit.
        now: returns the steady time in ns.
        has_waiting: returns True if a message has come that is not noted yet.
    """

    def __init__(
        self,
        on_change: Callable[[], object],
        period_ns: int,
        now: Callable[[], int],
        has_waiting: Callable[[], bool] = lambda: False,
    ) -> None:
        super().__init__(("total_count",), on_change)
        self._period_ns = period_ns
        self._now = now
        self._has_waiting = has_waiting
        self._last_ns: int | None = None

    def note(self) -> None:
        """Note a message."""
        if self._period_ns:
            if not self._has_waiting():
                self.settle()
            self._last_ns = self._now()

    def settle(self) -> None:
        """Count the periods that have passed."""
        if self._last_ns is None or self._has_waiting():
            return
        missed = (self._now() - self._last_ns) // self._period_ns
        if missed > 0:
            self._last_ns += missed * self._period_ns
            self.add("total_count", missed)

    def is_waiting(self) -> bool:
        """Return True if the numbers may change by the passing of time alone."""
        return bool(self._period_ns)

    @property
    def due_ns(self) -> int:
        """The end of the period."""
        return NEVER if self._last_ns is None else self._last_ns + self._period_ns


class LivelinessLost(Status):
    """Counts how often a publisher with MANUAL_BY_TOPIC did not assert that it is alive.

    Args:
        on_change: called when the numbers change.
        lease_ns: the longest time between two assertions; 0 for no limit.
        now: returns the steady time in ns.
    """

    def __init__(self, on_change: Callable[[], object], lease_ns: int, now: Callable[[], int]) -> None:
        super().__init__(("total_count",), on_change)
        self._lease_ns = lease_ns
        self._now = now
        self._ends_ns = NEVER
        self.was_asserted = False

    def note(self) -> None:
        """Note an assertion."""
        self.settle()
        self.was_asserted = True
        self._ends_ns = self._now() + self._lease_ns if self._lease_ns else NEVER

    def settle(self) -> None:
        """Count the loss if the time is over."""
        if self._now() >= self._ends_ns:
            self._ends_ns = NEVER
            self.was_asserted = False
            self.add("total_count", 1)

    def is_waiting(self) -> bool:
        """Return True if the numbers may change by the passing of time alone."""
        return True

    @property
    def due_ns(self) -> int:
        """The time of the loss without another assertion."""
        return self._ends_ns


class LivelinessChanged(Status):
    """Counts the publishers of a subscription that are alive, and those that are not.

    Args:
        on_change: called when the numbers change.
        states: returns the connected publishers with their `LivelinessLost`; None for one that is always alive.
    """

    def __init__(self, on_change: Callable[[], object], states: Callable[[], dict[Any, LivelinessLost | None]]) -> None:
        super().__init__(("alive_count", "not_alive_count"), on_change)
        self._states = states
        self._known: dict[Any, bool | None] = {}

    def settle(self) -> None:
        """Compare the publishers with the ones of the last look."""
        states = self._states()
        for link in [each for each in self._known if each not in states]:
            self._change(self._known.pop(link), None)
        for link, lost in states.items():
            if lost is not None:
                lost.settle()
            is_alive = lost is None or lost.was_asserted
            before = self._known.get(link)
            after = ALIVE if is_alive else NOT_ALIVE if before is not None else None  # never asserted: neither
            self._known[link] = after
            self._change(before, after)

    def _change(self, before: bool | None, after: bool | None) -> None:
        if before is after:
            return
        for state, name in ((ALIVE, "alive_count"), (NOT_ALIVE, "not_alive_count")):
            if before is state:
                self.add(name, -1)
            if after is state:
                self.add(name, 1)

    def is_waiting(self) -> bool:
        """Return True if the numbers may change by the passing of time alone."""
        return True

    @property
    def due_ns(self) -> int:
        """The time at which the next publisher is lost."""
        return min((lost.due_ns for lost in self._states().values() if lost is not None), default=NEVER)
