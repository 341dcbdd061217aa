"""The way to fly a mission: the plan of a run, its course from stop to stop, its results, and its determinism.

Code that decides how a mission is flown, or measures and compares runs, belongs here. `cfepy.mission` has only the
simulated computer. This package adds the monitors, scripts and faults that the mission file or the user requests. The
central file is `cfepy/pilot/pilot.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.pilot.determinism import RecordReader, RunEndedError
    from cfepy.pilot.determinism_look import place_text
    from cfepy.pilot.failure import LEAVES_OTHERS_WAITING, Failure, FailureKind, name_of_group
    from cfepy.pilot.failure_places import SourcePlaces
    from cfepy.pilot.idleness import idle_nodes
    from cfepy.pilot.mission_check import MissionProblem, check_mission, problem_of, shown_file
    from cfepy.pilot.never_judged import SentNames, no_such_app
    from cfepy.pilot.peers import boot_of
    from cfepy.pilot.pilot import BootError, Flown, Host, LiveRun, booting, fly, takeoff
    from cfepy.pilot.plan import LAUNCH, NODE, RUN, RunPlan, builder, built_node
    from cfepy.pilot.problems import RunProblem, failures_of, is_reported, problems_of, problems_so_far
    from cfepy.pilot.results import ENDED, NOT_STARTED, AppResult, Results, TopicResult, mark, never_happened
    from cfepy.pilot.run_loop import BOOT_S, DEFAULT_S, STALLED, SUDDEN, Course
    from cfepy.pilot.unconnected_topics import loose_ends

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
    "MissionProblem",
    "RecordReader",
    "Results",
    "RunEndedError",
    "RunPlan",
    "RunProblem",
    "SentNames",
    "SourcePlaces",
    "TopicResult",
    "boot_of",
    "booting",
    "builder",
    "built_node",
    "check_mission",
    "failures_of",
    "fly",
    "idle_nodes",
    "is_reported",
    "loose_ends",
    "mark",
    "name_of_group",
    "never_happened",
    "no_such_app",
    "place_text",
    "problem_of",
    "problems_of",
    "problems_so_far",
    "shown_file",
    "takeoff",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".determinism": ("RecordReader", "RunEndedError"),
            ".determinism_look": ("place_text",),
            ".mission_check": ("MissionProblem", "check_mission", "problem_of", "shown_file"),
            ".peers": ("boot_of",),
            ".run_loop": (
                "BOOT_S",
                "DEFAULT_S",
                "STALLED",
                "SUDDEN",
                "Course",
            ),
            ".failure": (
                "LEAVES_OTHERS_WAITING",
                "Failure",
                "FailureKind",
                "name_of_group",
            ),
            ".failure_places": ("SourcePlaces",),
            ".idleness": ("idle_nodes",),
            ".unconnected_topics": ("loose_ends",),
            ".never_judged": (
                "SentNames",
                "no_such_app",
            ),
            ".pilot": (
                "BootError",
                "Flown",
                "Host",
                "LiveRun",
                "booting",
                "fly",
                "takeoff",
            ),
            ".plan": (
                "LAUNCH",
                "NODE",
                "RUN",
                "RunPlan",
                "builder",
                "built_node",
            ),
            ".problems": (
                "RunProblem",
                "failures_of",
                "is_reported",
                "problems_of",
                "problems_so_far",
            ),
            ".results": (
                "ENDED",
                "NOT_STARTED",
                "AppResult",
                "Results",
                "TopicResult",
                "mark",
                "never_happened",
            ),
        },
    )
