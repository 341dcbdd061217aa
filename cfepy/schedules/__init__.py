"""The choice of the next task: schedules by name, and the kernels and policies that follow them.

Code that decides between ready tasks, or finds out what a decision depends on, belongs here. The search through many
schedules is in `cfepy.extra.exploration`. The central file is `cfepy/schedules/schedule.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.schedules.exploring import CallObserver, CallPointKernel, ExploringKernel
    from cfepy.schedules.kernels import make_kernel
    from cfepy.schedules.moves import Move, MoveNumbers, MovePolicy, MovesToMake, place_at, plain_name
    from cfepy.schedules.preemption_points import ATTRIBUTES, CALLS, LINES, SHARED, Points, name_of, source_names
    from cfepy.schedules.schedule import DEPTH, ORDER, STEPS, Schedule
    from cfepy.schedules.side_by_side import Abreast
    from cfepy.schedules.vector_clocks import Race, RaceSide, VectorClocks

__all__ = [
    "ATTRIBUTES",
    "CALLS",
    "DEPTH",
    "LINES",
    "ORDER",
    "SHARED",
    "STEPS",
    "Abreast",
    "CallObserver",
    "CallPointKernel",
    "ExploringKernel",
    "Move",
    "MoveNumbers",
    "MovePolicy",
    "MovesToMake",
    "Points",
    "Race",
    "RaceSide",
    "Schedule",
    "VectorClocks",
    "make_kernel",
    "name_of",
    "place_at",
    "plain_name",
    "source_names",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".side_by_side": ("Abreast",),
            ".exploring": ("CallObserver", "CallPointKernel", "ExploringKernel"),
            ".kernels": ("make_kernel",),
            ".moves": ("Move", "MoveNumbers", "MovePolicy", "MovesToMake", "place_at", "plain_name"),
            ".preemption_points": ("ATTRIBUTES", "CALLS", "LINES", "SHARED", "Points", "name_of", "source_names"),
            ".vector_clocks": ("Race", "RaceSide", "VectorClocks"),
            ".schedule": ("DEPTH", "ORDER", "STEPS", "Schedule"),
        },
    )
