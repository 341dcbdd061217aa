"""Event Services: what applications report, filtered, logged and sent on (cFE EVS).

The five services do not import each other; what EVS needs of them it finds in its `Ports`.
"""

from __future__ import annotations

from cfepy.evs.events import CRITICAL, DEBUG, ERROR, INFORMATION
from cfepy.evs.log import EventLog
from cfepy.evs.service import EventServices

__all__ = ["CRITICAL", "DEBUG", "ERROR", "INFORMATION", "EventLog", "EventServices"]
