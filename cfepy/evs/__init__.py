"""Event Services: the events of applications, filtered, logged and sent (cFE EVS).

Code that filters, logs or sends events, or configures this, belongs here. The ids and texts of particular events do
not: each service and application has its own. The five services are independent of one another; EVS reaches the others
through its `Ports`. The central file is `cfepy/evs/service.py`.
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

if not TYPE_CHECKING:  # type checkers see only the names above
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
