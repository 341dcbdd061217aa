"""Pauses of a ground station that last longer than the procedure asks for, as on a ground computer with other work.

A seed gives each pause its additional time. If a racy test is analysed, each pause is also a question to the schedule:
exact or late. So the analysis of schedules finds the few late pauses that decide the verdict.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from types import FrameType

from cfepy.rtos import AskingPolicy, Decision, Question

LATEST_S = 0.05
"""By how much a pause of a busy ground computer lasts longer."""
LATE_PAUSE = "late pause"
EXACT = "exact"
_MS_PER_S = 1_000


class Pauses:
    """Draws the additional time of each pause.

    Args:
        seed: of the additional times; 0 for exact pauses.
        latest_s: the longest additional time in s.
    """

    def __init__(self, seed: int, latest_s: float = LATEST_S) -> None:
        self._late = random.Random(seed) if seed else None
        self._latest_s = latest_s

    def additional(self) -> float:
        """Return the additional time of the next pause in s."""
        return 0.0 if self._late is None else self._late.uniform(0.0, self._latest_s)


class AskedPauses(Pauses):
    """Lets the schedule decide which of the pauses are late.

    Args:
        seed: of the additional times; must not be 0.
        answer: asks the schedule.
        place: returns the line of the procedure that pauses.
    """

    def __init__(self, seed: int, answer: Callable[[Question], int], place: Callable[[], str]) -> None:
        super().__init__(seed)
        self._answer, self._place = answer, place

    def additional(self) -> float:
        late = super().additional()
        answers = (EXACT, f"{late * _MS_PER_S:.3f}ms")
        name = f"pause at {self._place() or 'the start'}"
        return late if self._answer(Question(name, LATE_PAUSE, answers, f"{name} is {{}}")) else 0.0


class AllLate(AskingPolicy):
    """Makes every pause late, and decides everything else as another policy does."""

    def choose(self, decision: Decision) -> int:
        if decision.question is not None and decision.question.kind == LATE_PAUSE:
            return 1
        return self._inner.choose(decision)


def line_of(frame: FrameType | None, files: set[str]) -> str:
    """Return the innermost line of a procedure in a stack as "NAME:LINE", or an empty text.

    Args:
        frame: the innermost frame.
        files: paths of the procedures' files.
    """
    while frame is not None:
        file = frame.f_code.co_filename
        if file in files:
            return f"{file.rpartition('/')[2]}:{frame.f_lineno}"
        frame = frame.f_back
    return ""
