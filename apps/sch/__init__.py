"""SCH, the scheduler app: 100 slots per second, each of which sends the messages that its tables define.

NASA's SCH 2.2.2 on the interfaces of cFE 7: its commands, telemetry, tables, event ids and texts are NASA's. A mission
has either SCH or SCH_LAB.
"""

from __future__ import annotations

from dataclasses import replace

from .app import SCH_AppMain
from .packets import COMMANDS, MESSAGE_TABLE, SCHEDULE_TABLE, TELEMETRY
from .state import judge_messages, judge_schedule

TABLES = (
    replace(SCHEDULE_TABLE, fault=lambda image: judge_schedule(image).fault or None),
    replace(MESSAGE_TABLE, fault=lambda image: judge_messages(image).fault or None),
)

__all__ = ["COMMANDS", "TABLES", "TELEMETRY", "SCH_AppMain"]
