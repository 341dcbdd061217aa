"""The time of a ground station: when a procedure starts, and pauses that last longer than it asks for.

An operator starts a procedure at any time after the boot, and a ground computer has other work. A seed gives the start
and each pause their additional times. If a racy test is analysed, each of them is also a question to the schedule:
exact or late. So the analysis of schedules finds the few that decide the verdict.
"""

from __future__ import annotations

import random
from collections.abc import Callable
from types import FrameType

from cfepy.rtos import AskingPolicy, Decision, Question

LATEST_S = 0.05
"""By how much a pause of a busy ground computer lasts longer."""
LATEST_START_S = 20.0
"""By how much a procedure starts later."""
LATE_PAUSE = "late pause"
START = "start"
EXACT = "exact"
_MS_PER_S = 1_000


class Pauses:
    """Draws the additional time of each pause.

    Args:
        seed: of the additional times; 0 for exact pauses.
    """

    def __init__(self, seed: int) -> None:
        self._seed = seed
        self._late = random.Random(seed) if seed else None

    def start(self) -> float:
        """Return by how much the procedure starts later, in s."""
        return random.Random(f"start {self._seed}").uniform(0.0, LATEST_START_S) if self._seed else 0.0

    def additional(self) -> float:
        """Return the additional time of the next pause in s."""
        return 0.0 if self._late is None else self._late.uniform(0.0, LATEST_S)


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

    def start(self) -> float:
        return self._asked(super().start(), START)

    def additional(self) -> float:
        return self._asked(super().additional(), f"pause at {self._place() or 'the top'}")

    def _asked(self, late: float, name: str) -> float:
        answers = (EXACT, f"{late * _MS_PER_S:.3f}ms")
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
