"""cfepy: NASA's core Flight Executive and ROS 1 nodes together on one simulated processor, in pure Python.

    import cfepy

    run = cfepy.run("capture", seconds=20, seed=3)
    run.topic("/joint_states").to_numpy("position")

    with cfepy.boot("capture") as m:
        m.run_for(2.0)
        m.send("CFE_ES_NOOP")
        m.expect_event("CFE_ES", 3)

    cfepy.explore("my_mission", seeds=200).failures

Here is what a program needs that flies missions. What applications import is in the packages (`cfepy.app`, `cfepy.evs`
and so on), what tests use beyond this in `cfepy.testing`. Names are loaded when they are first used.
"""

from __future__ import annotations

import os as _os
import sys as _sys

if _os.path.basename((_sys.argv or [""])[0]).startswith(("cfepy", "-m")):  # perhaps the command
    import cfepy.interpreter.early_end as _early_end

    if _early_end.is_command():
        _early_end.leave_on_interrupt()  # before any other import, in which Ctrl-C would give its traceback

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.app import Cfe
    from cfepy.attachment import Attachment
    from cfepy.faults import FaultPlan
    from cfepy.flight import (
        App,
        ExpectationError,
        Explored,
        Flight,
        FoundFailure,
        MissionOptions,
        Packet,
        Picture,
        Run,
        RunOptions,
        boot,
        explore,
        replay,
    )
    from cfepy.flight.start import run
    from cfepy.ground import DecodedEvent, Samples, Series, SeriesSet
    from cfepy.monitors import Heard
    from cfepy.pilot import AppResult, Results, TopicResult
    from cfepy.schedules import Schedule
    from cfepy.status import CfeError, StallError, UsageError

__version__ = "0.1.0"
__all__ = [
    "App",
    "AppResult",
    "Attachment",
    "Cfe",
    "CfeError",
    "DecodedEvent",
    "ExpectationError",
    "Explored",
    "FaultPlan",
    "Flight",
    "FoundFailure",
    "Heard",
    "MissionOptions",
    "Packet",
    "Picture",
    "Results",
    "Run",
    "RunOptions",
    "Samples",
    "Schedule",
    "Series",
    "SeriesSet",
    "StallError",
    "TopicResult",
    "UsageError",
    "__version__",
    "boot",
    "compute",
    "explore",
    "replay",
    "run",
]


def compute(seconds: float) -> None:
    """In a ROS node that flies in a mission: work for so long, a stand-in for code whose time counts.

    More urgent tasks get in meanwhile. Anywhere else nothing happens: there the processor is really at work.

    Args:
        seconds: of virtual CPU time.

    Raises:
        ValueError: it is negative.
    """
    if seconds < 0:
        raise ValueError(f"invalid time {seconds:g} s; expected 0 or more")


if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            ".app": ("Cfe",),
            ".attachment": ("Attachment",),
            ".faults": ("FaultPlan",),
            ".flight": (
                "App",
                "ExpectationError",
                "Explored",
                "Flight",
                "FoundFailure",
                "MissionOptions",
                "Packet",
                "Picture",
                "Run",
                "RunOptions",
                "boot",
                "explore",
                "replay",
            ),
            ".flight.start": ("run",),
            ".ground": ("DecodedEvent", "Samples", "Series", "SeriesSet"),
            ".monitors": ("Heard",),
            ".pilot": ("AppResult", "Results", "TopicResult"),
            ".schedules": ("Schedule",),
            ".status": ("CfeError", "StallError", "UsageError"),
        },
    )
