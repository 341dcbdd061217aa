"""SCH_LAB, the scheduler app: sends the commands of its table, each with its period in ticks. NASA's sch_lab v2.3.0.

It has neither commands nor telemetry of its own.
"""

from __future__ import annotations

from .app import SCH_LAB_AppMain
from .schedule import TABLES

__all__ = ["TABLES", "SCH_LAB_AppMain"]
