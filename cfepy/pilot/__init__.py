"""The one way to fly a mission: a plan of the run, its course from stop to stop, its results, and its determinism.

What belongs here decides how a mission is flown, or measures and compares runs. `cfepy.mission` has the simulated
computer alone; this package adds the monitors, scripts and faults that the mission file or the user asks for.
"""

from __future__ import annotations

from cfepy.pilot.company import boot_of
from cfepy.pilot.course import BOOT_S, DEFAULT_S, STALLED, SUDDEN, Course
from cfepy.pilot.failure import LEAVES_OTHERS_WAITING, Failure, FailureKind
from cfepy.pilot.never_judged import SentNames, no_such_app
from cfepy.pilot.pilot import BootError, Flown, Host, LiveRun, booting, fly, takeoff
from cfepy.pilot.plan import LAUNCH, NODE, RUN, RunPlan, builder, built_node
from cfepy.pilot.problems import RunProblem, failures_of, is_reported, problems_of, problems_so_far
from cfepy.pilot.results import ENDED, NOT_STARTED, AppResult, Results, TopicResult, mark, never_happened

__all__ = [
    "BOOT_S",
    "DEFAULT_S",
    "ENDED",
    "LAUNCH",
    "LEAVES_OTHERS_WAITING",
    "NODE",
    "NOT_STARTED",
    "RUN",
    "STALLED",
    "SUDDEN",
    "AppResult",
    "BootError",
    "Course",
    "Failure",
    "FailureKind",
    "Flown",
    "Host",
    "LiveRun",
    "Results",
    "RunPlan",
    "RunProblem",
    "SentNames",
    "TopicResult",
    "boot_of",
    "booting",
    "builder",
    "built_node",
    "failures_of",
    "fly",
    "is_reported",
    "mark",
    "never_happened",
    "no_such_app",
    "problems_of",
    "problems_so_far",
    "takeoff",
]
