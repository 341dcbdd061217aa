"""Which task goes first: schedules by name, and the kernels and policies that follow them.

What belongs here decides between tasks that could run, or finds out what a decision depends on. A search through many
schedules does not: that is `cfepy.extra.exploration`. The central file is `cfepy/schedules/schedule.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.schedules.abreast import Abreast
    from cfepy.schedules.exploring import CallObserver, CallPointKernel, ExploringKernel
    from cfepy.schedules.kernels import make_kernel
    from cfepy.schedules.moves import Move, MoveNumbers, MovePolicy, MovesToMake, plain_name
    from cfepy.schedules.points import ATTRIBUTES, CALLS, LINES, Points
    from cfepy.schedules.races import Race, RaceSide, VectorClocks
    from cfepy.schedules.schedule import DEPTH, ORDER, STEPS, Schedule

__all__ = [
    "ATTRIBUTES",
    "CALLS",
    "DEPTH",
    "LINES",
    "ORDER",
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
    "plain_name",
]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            ".abreast": ("Abreast",),
            ".exploring": ("CallObserver", "CallPointKernel", "ExploringKernel"),
            ".kernels": ("make_kernel",),
            ".moves": ("Move", "MoveNumbers", "MovePolicy", "MovesToMake", "plain_name"),
            ".points": ("ATTRIBUTES", "CALLS", "LINES", "Points"),
            ".races": ("Race", "RaceSide", "VectorClocks"),
            ".schedule": ("DEPTH", "ORDER", "STEPS", "Schedule"),
        },
    )
