"""SCH_LAB, the scheduler app: sends the commands of its table, each every so many ticks. NASA's sch_lab v2.3.0."""

from __future__ import annotations

from .app import SCH_LAB_AppMain

__all__ = ["SCH_LAB_AppMain"]
