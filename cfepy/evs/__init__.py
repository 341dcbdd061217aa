"""Event Services: what applications report, filtered, logged and sent on (cFE EVS).

What belongs here filters, logs or sends events, or changes how that is done. The ids and texts of particular events do
not: each service and application has its own. The five services do not import each other; what EVS needs of the others
it finds in its `Ports`. The central file is `cfepy/evs/service.py`.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy.interpreter.faces import face

if TYPE_CHECKING:
    from cfepy.evs.core import SentError
    from cfepy.evs.events import (
        CRITICAL,
        DEBUG,
        ERROR,
        EVERY_FOURTH_ONE,
        EVERY_OTHER_ONE,
        EVERY_OTHER_TWO,
        FIRST_4_STOP,
        FIRST_8_STOP,
        FIRST_16_STOP,
        FIRST_32_STOP,
        FIRST_64_STOP,
        FIRST_ONE_STOP,
        FIRST_TWO_STOP,
        INFORMATION,
        NO_FILTER,
    )
    from cfepy.evs.log import EventLog
    from cfepy.evs.packets import COMMANDS, TELEMETRY
    from cfepy.evs.service import EVENT_FILTER_BINARY, EventServices

__all__ = [
    "COMMANDS",
    "CRITICAL",
    "DEBUG",
    "ERROR",
    "EVENT_FILTER_BINARY",
    "EVERY_FOURTH_ONE",
    "EVERY_OTHER_ONE",
    "EVERY_OTHER_TWO",
    "FIRST_4_STOP",
    "FIRST_8_STOP",
    "FIRST_16_STOP",
    "FIRST_32_STOP",
    "FIRST_64_STOP",
    "FIRST_ONE_STOP",
    "FIRST_TWO_STOP",
    "INFORMATION",
    "NO_FILTER",
    "TELEMETRY",
    "EventLog",
    "EventServices",
    "SentError",
]

if not TYPE_CHECKING:  # a type checker sees the names above, and no others
    __getattr__, __dir__ = face(
        __name__,
        {
            ".core": ("SentError",),
            ".events": (
                "CRITICAL",
                "DEBUG",
                "ERROR",
                "EVERY_FOURTH_ONE",
                "EVERY_OTHER_ONE",
                "EVERY_OTHER_TWO",
                "FIRST_4_STOP",
                "FIRST_8_STOP",
                "FIRST_16_STOP",
                "FIRST_32_STOP",
                "FIRST_64_STOP",
                "FIRST_ONE_STOP",
                "FIRST_TWO_STOP",
                "INFORMATION",
                "NO_FILTER",
            ),
            ".log": ("EventLog",),
            ".packets": (
                "COMMANDS",
                "TELEMETRY",
            ),
            ".service": (
                "EVENT_FILTER_BINARY",
                "EventServices",
            ),
        },
    )
