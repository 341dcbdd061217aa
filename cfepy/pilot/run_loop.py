"""The course of a run: its length, the steps of its script on the way, and the state at its end.

A caller flies a mission from stop to stop. The run does not depend on the position of the stops.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, ClassVar

from cfepy.mission import Mission
from cfepy.pilot.results import Mark, mark
from cfepy.units import NS_PER_S

if TYPE_CHECKING:
    from cfepy.script import Outcome, ScriptRun

OVER, INTERRUPTED, BROKEN_OFF, STALLED = "over", "interrupted", "broken off", "stalled"
"""How a run ends: on its own, by Ctrl-C between two instants, by Ctrl-C during a task, or because a task did not give
up the CPU.
"""
SUDDEN = (BROKEN_OFF, STALLED)
"""The ends in the middle of a task: such a run has no digest, and no final state to compare."""
DEFAULT_S = 10.0
LONGEST_S = 1e9  # virtual time is a signed 64-bit number of ns
NODE_S = 60.0  # default virtual time of a single node
BOOT_S = 0.55  # virtual time until nodes of a launch file start; rates of their messages count from there


class Course:
    """The course of a run until the end of its time, of its script or of its nodes.

    Args:
        mission: the mission, with the script attached.
        seconds: virtual time to run in s; None means the length of the script, or 10 s without one.
        script: the steps on the way.

    Attributes:
        at: the state at the end of the time; set by `end`.
        outcome: result of the script, None without one; set by `end`.
        takes_company: whether missions can fly together with it; for a replay, their messages are already recorded.
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
        """Whether there is time left to run."""
        return self.mission.kernel.now < self.until_ns and not self.is_over

    @property
    def is_over(self) -> bool:
        """Whether the run has ended before its time: its script or its nodes have ended."""
        script = self._script
        if script is not None and (script.stopped or (script.finished and self._ends_with_script)):
            return True
        return self.mission.over

    def next_stop(self) -> int:
        """Return the virtual time in ns until which the run may continue; the script performs its due steps now."""
        return self.until_ns if self._script is None else min(self.until_ns, self._script.advance())

    def run(self) -> None:
        """Run to the end without a break."""
        stop_ns = self.next_stop()
        while self.goes_on:
            self.mission.run_until(stop_ns)
            stop_ns = self.next_stop()

    def end(self, wall_ns: int = 0) -> None:
        """End the time: collect the results before the nodes shut down.

        Args:
            wall_ns: wall-clock time of the run in ns.
        """
        self.mission.conclude()
        self.at = mark(self.mission, wall_ns)
        if self._script is not None:
            self.outcome = self._script.end()


def duration(seconds: float | None, script: ScriptRun | None = None) -> float:
    """Return the virtual seconds of a run; with a script and no other length, the maximum."""
    if seconds is not None:
        return seconds
    return DEFAULT_S if script is None else script.script.longest_ns / NS_PER_S
