"""The course of a run: how long it goes on, the steps of its script on the way, and the state at its end.

A caller flies a mission from stop to stop; nothing in the run depends on where it stops.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from cfepy.mission import Mission
from cfepy.pilot.results import Mark, mark
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from cfepy.script import Outcome, ScriptRun

OVER, INTERRUPTED, BROKEN_OFF, STALLED = "over", "interrupted", "broken off", "stalled"
"""How a run ends: by itself; by Ctrl-C between two instants; by Ctrl-C in the middle of a task; because a task did not
give up the CPU."""
SUDDEN = (BROKEN_OFF, STALLED)
"""Ends in the middle of something: such a run has no digest, and nothing to be held against at its last instant."""
DEFAULT_S = 10.0
LONGEST_S = 1e9  # virtual time is a signed 64-bit number of ns
NODE_S = 60.0  # virtual time that a single node gets when no length is given
BOOT_S = 0.55  # virtual time until nodes of a launch file start, which does not count as theirs


class Course:
    """A run until its time is over, its script is at its end, or its nodes are.

    Args:
        mission: the mission, with the script attached.
        seconds: virtual time to run; None is as long as the script takes, or 10 s without one.
        script: what is to happen on the way.

    Attributes:
        at: what there was when the time was over; set by `end`.
        outcome: of the script, None without one; set by `end`.
        takes_company: whether missions can fly beside it; what came of them is on record for a replay.
    """

    takes_company: ClassVar[bool] = True

    def __init__(self, mission: Mission, seconds: float | None, script: ScriptRun | None = None) -> None:
        self.mission = mission
        self.at: Mark
        self.outcome: Outcome | None = None
        self.until_ns = round(duration(seconds, script) * NS_PER_S)
        self._script = script
        self._ends_with_script = seconds is None

    @property
    def goes_on(self) -> bool:
        """Whether there is something left to run."""
        return self.mission.kernel.now < self.until_ns and not self.is_over

    @property
    def is_over(self) -> bool:
        """Whether the run has come to its end before its time is over: its script has, or its nodes have."""
        script = self._script
        if script is not None and (script.stopped or (script.finished and self._ends_with_script)):
            return True
        return self.mission.over

    def next_stop(self) -> int:
        """Virtual time in ns until which the run may go on by itself; the script does what is due now."""
        return self.until_ns if self._script is None else min(self.until_ns, self._script.advance())

    def run(self) -> None:
        """Go on to the end in one go."""
        stop_ns = self.next_stop()
        while self.goes_on:
            self.mission.run_until(stop_ns)
            stop_ns = self.next_stop()

    def end(self, wall_ns: int = 0) -> None:
        """The time is over: collect the results before the nodes shut down.

        Args:
            wall_ns: wall-clock time that the run took.
        """
        self.mission.conclude()
        self.at = mark(self.mission, wall_ns)
        if self._script is not None:
            self.outcome = self._script.end()


def duration(seconds: float | None, script: ScriptRun | None = None) -> float:
    """Virtual seconds that a run takes; with a script and nothing else said, at most."""
    if seconds is not None:
        return seconds
    return DEFAULT_S if script is None else script.script.longest_ns / NS_PER_S
