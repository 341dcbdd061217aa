"""The failures of a run as a search counts them: the failures of its problems, without the events that do not count."""

from __future__ import annotations

from collections.abc import Iterable

from cfepy.attachment import Attachment
from cfepy.extra.exploration.verdict import EVENT, Failure
from cfepy.mission import CORE_APPS, FailedCode, Mission
from cfepy.pilot import RunProblem, failures_of, problems_so_far

EVENT_LEVELS = {"error": ("ERROR", "CRITICAL"), "critical": ("CRITICAL",), "none": ()}
"""Events that count as failures, by the value of `--events` of `cfepy explore`."""


class FailureWatch(Attachment):
    """Collects the failures of a run.

    Args:
        events: a key of EVENT_LEVELS.

    Attributes:
        end_ns: virtual time at the end of the run.
    """

    def __init__(self, events: str = "error") -> None:
        self.end_ns = 0
        self._levels = EVENT_LEVELS[events]
        self._mission: Mission | None = None

    def begin(self, mission: Mission) -> None:
        self._mission = mission

    def conclude(self) -> None:
        assert self._mission is not None
        self.end_ns = self._mission.kernel.now

    @property
    def trouble(self) -> list[str]:
        """Errors of cfepy's own tasks, a traceback each. They are not errors of the mission."""
        assert self._mission is not None
        return [each.detail for each in self._mission.record.part(FailedCode).died if each.who in CORE_APPS]

    def saw(self, group: str) -> bool:
        """Return True if there has been a failure of this group so far, among the failures that show during the run."""
        assert self._mission is not None
        return any(failure.group == group for failure in self.failures(problems_so_far(self._mission)))

    def failures(self, problems: Iterable[RunProblem]) -> tuple[Failure, ...]:
        """Return the failures behind the problems of the run by time, the first of each group."""
        first: dict[str, Failure] = {}
        for failure in failures_of(problems):
            if failure.who not in CORE_APPS and self._counts(failure):
                first.setdefault(failure.group, failure)
        return tuple(first.values())

    def _counts(self, failure: Failure) -> bool:
        return failure.kind != EVENT or failure.text.partition(" ")[0] in self._levels
