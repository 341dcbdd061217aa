"""SAMPLE_APP, the smallest real cFE app: commands, telemetry, events and a table. Start here, and copy it."""

from __future__ import annotations

from .app import SAMPLE_APP_Main

__all__ = ["SAMPLE_APP_Main"]
