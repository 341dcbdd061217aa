"""Exploration of schedules: fly a mission under many schedules, tell failures apart, and shorten a failing schedule.

Code that works with many runs of one mission, which differ in which task goes first, belongs here. It chooses schedules
(`search`) and flies them in processes (`campaign`, `worker_pools`, `workers`). It defines failures (`trial`,
`failure_kinds`, `deadlock`, `result_watch`), and shortens and shows a failing schedule (`shrink`, `timeline`). The same
processes fly runs that differ in their plans, such as rates and boards (`batch`, `sweep`). The policies that decide
within one run belong to `cfepy.rtos`; properties of every run belong to `cfepy.monitors`. The central file is
`cfepy/extra/exploration/exploration.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.extra.exploration.batch import Lot, answers
    from cfepy.extra.exploration.draws import Drawn, draws_of
    from cfepy.extra.exploration.exploration import DEFAULT_SEEDS, Expedition, Report, Told
    from cfepy.extra.exploration.field_measures import FieldMeasure, FieldValue
    from cfepy.extra.exploration.longest import Worst
    from cfepy.extra.exploration.made_moves import MadeMove, MoveNotingPolicy
    from cfepy.extra.exploration.mission_transfer import files_read, ship
    from cfepy.extra.exploration.monte_carlo import Group, Quantity, groups_of
    from cfepy.extra.exploration.monte_carlo_picture import picture_of_draws
    from cfepy.extra.exploration.progress import make_progress
    from cfepy.extra.exploration.replays import GONE, NOT_POSSIBLE, STILL_THERE, ReplayedFailure, replay_all
    from cfepy.extra.exploration.schedule_kinds import seeded_kinds
    from cfepy.extra.exploration.search import SeededSearch
    from cfepy.extra.exploration.shrink import SHRINK_S, NotedFlight, Shrinkable, Shrinker, Shrunk, budget_of
    from cfepy.extra.exploration.sweep import (
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
    from cfepy.extra.exploration.sweep_picture import SweepLine, picture_of_sweep
    from cfepy.extra.exploration.sweep_points import numbers_of, points_of, seeds_of, values_of
    from cfepy.extra.exploration.timeline import WIDTH, Story, story_of, story_of_run, story_width
    from cfepy.extra.exploration.trial import Trial, Tried
    from cfepy.extra.exploration.verdict import Failure, Finding, Verdict
    from cfepy.extra.exploration.worker_pools import make_crew

__all__ = [
    "DEFAULT_SEEDS",
    "GONE",
    "NOT_POSSIBLE",
    "SHRINK_S",
    "STILL_THERE",
    "WIDTH",
    "Drawn",
    "Expedition",
    "Failure",
    "FieldMeasure",
    "FieldValue",
    "Finding",
    "Group",
    "Knee",
    "Lot",
    "MadeMove",
    "MoveNotingPolicy",
    "NotedFlight",
    "Point",
    "PointNumbers",
    "Quantity",
    "ReplayedFailure",
    "Report",
    "SeededSearch",
    "Shrinkable",
    "Shrinker",
    "Shrunk",
    "Story",
    "Sweep",
    "SweepLine",
    "SweepRow",
    "Told",
    "TopicNumbers",
    "Trial",
    "Tried",
    "Verdict",
    "Worst",
    "answers",
    "budget_of",
    "draws_of",
    "files_read",
    "groups_of",
    "knees",
    "make_crew",
    "make_progress",
    "numbers_of",
    "picture_of_draws",
    "picture_of_sweep",
    "points_of",
    "replay_all",
    "seconds_text",
    "seeded_kinds",
    "seeds_of",
    "ship",
    "story_of",
    "story_of_run",
    "story_width",
    "sweep_table",
    "values_of",
]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            ".worker_pools": ("make_crew",),
            ".batch": (
                "Lot",
                "answers",
            ),
            ".progress": ("make_progress",),
            ".made_moves": ("MadeMove", "MoveNotingPolicy"),
            ".search": ("SeededSearch",),
            ".mission_transfer": (
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
            ".sweep_picture": ("SweepLine", "picture_of_sweep"),
            ".sweep_points": (
                "numbers_of",
                "points_of",
                "seeds_of",
                "values_of",
            ),
            ".draws": ("Drawn", "draws_of"),
            ".field_measures": ("FieldMeasure", "FieldValue"),
            ".monte_carlo": ("Group", "Quantity", "groups_of"),
            ".monte_carlo_picture": ("picture_of_draws",),
            ".exploration": (
                "DEFAULT_SEEDS",
                "Expedition",
                "Report",
                "Told",
            ),
            ".replays": ("GONE", "NOT_POSSIBLE", "STILL_THERE", "ReplayedFailure", "replay_all"),
            ".shrink": (
                "SHRINK_S",
                "NotedFlight",
                "Shrinkable",
                "Shrinker",
                "Shrunk",
                "budget_of",
            ),
            ".timeline": (
                "WIDTH",
                "Story",
                "story_of",
                "story_of_run",
                "story_width",
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
            ".schedule_kinds": ("seeded_kinds",),
            ".longest": ("Worst",),
        },
    )
