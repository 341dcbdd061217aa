"""Exploring schedules: a mission is flown under many, failures are told apart, and a failing schedule is made short.

What belongs here works with many runs of one mission that differ in which task goes first: the choice of schedules
(`search`), the processes that fly them (`campaign`, `crews`, `workers`), what counts as a failure (`trial`, `failures`,
`stuck`, `result_watch`), and how a failing schedule is made short and shown (`shrink`, `timeline`). The policies that
decide within one run belong to `cfepy.rtos`; what must hold of every run belongs to `cfepy.monitors`.

The names below are loaded when they are first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.faces import face

if TYPE_CHECKING:
    from cfepy.exploration.expedition import DEFAULT_SEEDS, Expedition, Report, Told
    from cfepy.exploration.failures import TracebackReader
    from cfepy.exploration.moves import MadeMove
    from cfepy.exploration.replays import GONE, NOT_POSSIBLE, STILL_THERE, ReplayedFailure, replay_all
    from cfepy.exploration.shrink import Shrinkable, Shrinker, Shrunk, budget_of
    from cfepy.exploration.task_look import TaskLook
    from cfepy.exploration.timeline import WIDTH, Story, important, story_of_run
    from cfepy.exploration.trial import Trial, Tried
    from cfepy.exploration.verdict import Failure, Finding, Verdict
    from cfepy.exploration.worst import Worst

__all__ = [
    "DEFAULT_SEEDS",
    "GONE",
    "NOT_POSSIBLE",
    "STILL_THERE",
    "WIDTH",
    "Expedition",
    "Failure",
    "Finding",
    "MadeMove",
    "ReplayedFailure",
    "Report",
    "Shrinkable",
    "Shrinker",
    "Shrunk",
    "Story",
    "TaskLook",
    "Told",
    "TracebackReader",
    "Trial",
    "Tried",
    "Verdict",
    "Worst",
    "budget_of",
    "important",
    "replay_all",
    "story_of_run",
]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            ".expedition": (
                "DEFAULT_SEEDS",
                "Expedition",
                "Report",
                "Told",
            ),
            ".failures": ("TracebackReader",),
            ".moves": ("MadeMove",),
            ".replays": ("GONE", "NOT_POSSIBLE", "STILL_THERE", "ReplayedFailure", "replay_all"),
            ".shrink": (
                "Shrinkable",
                "Shrinker",
                "Shrunk",
                "budget_of",
            ),
            ".task_look": ("TaskLook",),
            ".timeline": (
                "WIDTH",
                "Story",
                "important",
                "story_of_run",
            ),
            ".trial": (
                "Trial",
                "Tried",
            ),
            ".verdict": (
                "Failure",
                "Finding",
                "Verdict",
            ),
            ".worst": ("Worst",),
        },
    )
