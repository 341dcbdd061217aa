"""SAMPLE_APP, the smallest real cFE app: commands, telemetry, events and a table. Start here, and copy it."""

from __future__ import annotations

from .app import SAMPLE_APP_Main
from .packets import COMMANDS, TABLES, TELEMETRY

__all__ = ["COMMANDS", "TABLES", "TELEMETRY", "SAMPLE_APP_Main"]
