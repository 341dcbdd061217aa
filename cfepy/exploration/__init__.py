"""Exploring schedules: a mission is flown under many, failures are told apart, and a failing schedule is made short.

What belongs here works with many runs of one mission that differ in which task goes first: the choice of schedules
(`search`), the processes that fly them (`campaign`, `crews`, `workers`), what counts as a failure (`trial`, `failures`,
`stuck`, `result_watch`), and how a failing schedule is made short and shown (`shrink`, `timeline`). The same processes
fly runs that differ in their plans, such as rates and boards (`lot`, `sweep`). The policies that
decide within one run belong to `cfepy.rtos`; what must hold of every run belongs to `cfepy.monitors`.

The names below are loaded when they are first used.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.faces import face

if TYPE_CHECKING:
    from cfepy.exploration.crews import make_crew
    from cfepy.exploration.expedition import DEFAULT_SEEDS, Expedition, Report, Told
    from cfepy.exploration.lot import Lot, answers
    from cfepy.exploration.moves import MadeMove
    from cfepy.exploration.progress import make_progress
    from cfepy.exploration.replays import GONE, NOT_POSSIBLE, STILL_THERE, ReplayedFailure, replay_all
    from cfepy.exploration.search import SeededSearch, seeded_kinds
    from cfepy.exploration.shipment import files_read, ship
    from cfepy.exploration.shrink import Shrinkable, Shrinker, Shrunk, budget_of
    from cfepy.exploration.sweep import (
        Knee,
        Point,
        PointNumbers,
        Sweep,
        SweepRow,
        TopicNumbers,
        knees,
        seconds_text,
        sweep_table,
    )
    from cfepy.exploration.sweep_points import numbers_of, points_of, seeds_of, values_of
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
    "Knee",
    "Lot",
    "MadeMove",
    "Point",
    "PointNumbers",
    "ReplayedFailure",
    "Report",
    "SeededSearch",
    "Shrinkable",
    "Shrinker",
    "Shrunk",
    "Story",
    "Sweep",
    "SweepRow",
    "TaskLook",
    "Told",
    "TopicNumbers",
    "Trial",
    "Tried",
    "Verdict",
    "Worst",
    "answers",
    "budget_of",
    "files_read",
    "important",
    "knees",
    "make_crew",
    "make_progress",
    "numbers_of",
    "points_of",
    "replay_all",
    "seconds_text",
    "seeded_kinds",
    "seeds_of",
    "ship",
    "story_of_run",
    "sweep_table",
    "values_of",
]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            ".crews": ("make_crew",),
            ".lot": (
                "Lot",
                "answers",
            ),
            ".progress": ("make_progress",),
            ".search": (
                "SeededSearch",
                "seeded_kinds",
            ),
            ".shipment": (
                "files_read",
                "ship",
            ),
            ".sweep": (
                "Knee",
                "Point",
                "PointNumbers",
                "SweepRow",
                "Sweep",
                "TopicNumbers",
                "knees",
                "seconds_text",
                "sweep_table",
            ),
            ".sweep_points": (
                "numbers_of",
                "points_of",
                "seeds_of",
                "values_of",
            ),
            ".expedition": (
                "DEFAULT_SEEDS",
                "Expedition",
                "Report",
                "Told",
            ),
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
