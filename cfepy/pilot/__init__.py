"""The one way to fly a mission: a plan of the run, its course from stop to stop, its results, and its determinism.

What belongs here decides how a mission is flown, or measures and compares runs. `cfepy.mission` has the simulated
computer alone; this package adds the monitors, scripts and faults that the mission file or the user asks for.
"""

from __future__ import annotations

from cfepy.pilot.company import boot_of
from cfepy.pilot.course import BOOT_S, DEFAULT_S, STALLED, SUDDEN, Course
from cfepy.pilot.pilot import BootError, Flown, Host, LiveRun, booting, fly, takeoff
from cfepy.pilot.plan import LAUNCH, NODE, RUN, RunPlan, builder, built_node
from cfepy.pilot.results import (
    ENDED,
    NOT_STARTED,
    AppResult,
    Results,
    RunProblem,
    TopicResult,
    end_of,
    ended_badly,
    mark,
    never_happened,
    problems_in,
)

__all__ = [
    "BOOT_S",
    "DEFAULT_S",
    "ENDED",
    "LAUNCH",
    "NODE",
    "NOT_STARTED",
    "RUN",
    "STALLED",
    "SUDDEN",
    "AppResult",
    "BootError",
    "Course",
    "Flown",
    "Host",
    "LiveRun",
    "Results",
    "RunPlan",
    "RunProblem",
    "TopicResult",
    "boot_of",
    "booting",
    "builder",
    "built_node",
    "end_of",
    "ended_badly",
    "fly",
    "mark",
    "never_happened",
    "problems_in",
    "takeoff",
]
