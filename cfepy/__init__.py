"""cfepy: NASA's core Flight Executive and ROS 1 nodes together on one simulated processor, in pure Python.

    import cfepy

    run = cfepy.run("capture", seconds=20, seed=3)
    run.topic("/joint_states").to_numpy("position")

    with cfepy.boot("capture") as m:
        m.run_for(2.0)
        m.send("CFE_ES_NOOP")
        m.expect_event("CFE_ES", 3)

    cfepy.explore("my_mission", seeds=200).failures

This module offers the names that a program needs to fly missions. Applications import from the packages (`cfepy.app`,
`cfepy.evs` and so on). Tests find more in `cfepy.testing`. Names are loaded when they are first used.
"""

from __future__ import annotations

import os as _os
import sys as _sys

if _os.path.basename((_sys.argv or [""])[0]).startswith(("cfepy", "-m")):  # this may be the `cfepy` command
    import cfepy.interpreter.early_end as _early_end

    if _early_end.is_command():
        _early_end.leave_on_interrupt()  # before any other import: Ctrl-C during one would print a traceback

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
    """Use virtual CPU time in a ROS node of a mission, in place of code whose execution time matters.

    Tasks with a higher priority can preempt the node meanwhile. Outside a mission the call does nothing, because there
    the real processor does the work.

    Args:
        seconds: virtual CPU time to use, in s.

    Raises:
        ValueError: if `seconds` is negative.
    """
    if seconds < 0:
        raise ValueError(f"invalid time {seconds:g} s; expected 0 or more")


if not TYPE_CHECKING:  # type checkers see only the names above
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
