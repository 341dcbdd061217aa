"""CI_LAB, the command ingest app: puts datagrams from UDP port 1234 on the Software Bus. NASA's ci_lab v7.0.0."""

from __future__ import annotations

from .app import CI_LAB_AppMain
from .packets import COMMANDS, TELEMETRY

__all__ = ["COMMANDS", "TELEMETRY", "CI_LAB_AppMain"]
