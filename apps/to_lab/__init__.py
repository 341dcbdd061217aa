"""TO_LAB, the telemetry output app: sends the packets of its table to UDP port 1235 of the ground.

NASA's to_lab v2.3.0, the version of cFE v7.0.0 (equuleus-rc1+dev62).
"""

from __future__ import annotations

from .app import TO_LAB_AppMain
from .packets import COMMANDS, TABLES, TELEMETRY

__all__ = ["COMMANDS", "TABLES", "TELEMETRY", "TO_LAB_AppMain"]
