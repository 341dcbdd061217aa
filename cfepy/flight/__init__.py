"""A mission in the hands of a program: flown step by step, or examined after its flight.

The actions of a test, a notebook or a script on a mission belong here: let it run, send and publish, wait for events
and messages, and read the sent packets. Flying a run is in `cfepy.pilot`, and the pytest parts are in `cfepy.testing`.
The central file is `cfepy/flight/flight.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.flight.explored import Explored, FoundFailure, explore
    from cfepy.flight.flight import Flight
    from cfepy.flight.log import Packet
    from cfepy.flight.message_library import SECONDS, array_of, build, library_near, library_of_class
    from cfepy.flight.notebook import Picture
    from cfepy.flight.plans import (
        SEED,
        Faults,
        MissionOptions,
        RunOptions,
        command_for,
        fault_attachments,
        fault_text,
        schedule_of,
    )
    from cfepy.flight.run import App, ExpectationError, Run
    from cfepy.flight.start import boot, replay

__all__ = [
    "SECONDS",
    "SEED",
    "App",
    "ExpectationError",
    "Explored",
    "Faults",
    "Flight",
    "FoundFailure",
    "MissionOptions",
    "Packet",
    "Picture",
    "Run",
    "RunOptions",
    "array_of",
    "boot",
    "build",
    "command_for",
    "explore",
    "fault_attachments",
    "fault_text",
    "library_near",
    "library_of_class",
    "replay",
    "schedule_of",
]

if not TYPE_CHECKING:  # type checkers see only the names above
    __getattr__, __dir__ = face(
        __name__,
        {
            ".explored": ("Explored", "FoundFailure", "explore"),
            ".flight": ("Flight",),
            ".message_library": ("SECONDS", "array_of", "build", "library_near", "library_of_class"),
            ".log": ("Packet",),
            ".notebook": ("Picture",),
            ".plans": (
                "SEED",
                "Faults",
                "MissionOptions",
                "RunOptions",
                "command_for",
                "fault_attachments",
                "fault_text",
                "schedule_of",
            ),
            ".run": ("App", "ExpectationError", "Run"),
            ".start": ("boot", "replay"),
        },
    )
