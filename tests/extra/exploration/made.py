"""Moves of a run, for tests."""

from __future__ import annotations

from cfepy.extra.exploration.made_moves import MadeMove
from cfepy.schedules import Move


def moved(task: str, chosen: str) -> MadeMove:
    """Return a move in which another task preempts a task."""
    return MadeMove(Move(task, chosen), task, chosen, preempts=True, question="", decision=0, choice=1)
