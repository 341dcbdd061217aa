"""Event Services: what applications report, filtered, logged and sent on (cFE EVS).

What belongs here filters, logs or sends events, or changes how that is done. The ids and texts of particular events do
not: each service and application has its own. The five services do not import each other; what EVS needs of the others
it finds in its `Ports`.
"""

from __future__ import annotations

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
