"""When a fault happens: `When` says it, a `Gate` counts and decides. Imports the units of cfepy.rtos only."""

from __future__ import annotations

from dataclasses import dataclass
from random import Random


@dataclass(frozen=True, slots=True)
class When:
    """At which occasions a fault happens; an occasion is a message, a call or a tick that matches the fault.

    Attributes:
        at_ns: virtual times in ns. A fault of occasions happens at the next one after each of them.
        after_ns, until_ns: the window of virtual time, its end not included; None is the end of the run.
        number: which occasions within the window, from 1; any when empty.
        every: only every so many-th of them.
        probability: of each that is left, 0 to 1.
        count: most times that it happens; None for no limit.
    """

    at_ns: tuple[int, ...] = ()
    after_ns: int = 0
    until_ns: int | None = None
    number: tuple[int, ...] = ()
    every: int = 1
    probability: float = 1.0
    count: int | None = None


class Gate:
    """Decides for one fault, through all resets of the processor.

    Args:
        when: at which occasions.
        random: the fault's own stream of random numbers, so that no other fault changes its draws.

    Attributes:
        seen: occasions so far, outside the window too.
        fired: how often it happened.
    """

    def __init__(self, when: When, random: Random) -> None:
        self.when = when
        self.random = random
        self.seen = self.fired = 0
        self._inside = 0
        self._waiting = sorted(when.at_ns)

    def opens(self, now_ns: int) -> bool:
        """Whether the fault happens at this occasion."""
        self.seen += 1
        if not self._is_due(now_ns):
            return False
        self.fired += 1
        return True

    def is_open(self, now_ns: int) -> bool:
        """Whether it is within the window of time."""
        when = self.when
        return when.after_ns <= now_ns and (when.until_ns is None or now_ns < when.until_ns)

    def _is_due(self, now_ns: int) -> bool:
        when = self.when
        if not self.is_open(now_ns) or (when.count is not None and self.fired >= when.count):
            return False
        if when.at_ns:
            if not self._waiting or now_ns < self._waiting[0]:
                return False
            self._waiting.pop(0)
            return True
        self._inside += 1
        if (when.number and self._inside not in when.number) or self._inside % when.every:
            return False
        return when.probability >= 1 or self.random.random() < when.probability

    def why_not(self) -> str:
        """Why it never happened, as far as its occasions can tell."""
        if not self.seen:
            return "nothing that it is about happened"
        times = "1 time" if self.seen == 1 else f"{self.seen} times"
        if not self._inside:
            return f"matched {times}, but not in its window of time"
        return f"matched {times}, but no time was one of those that it asks for"
