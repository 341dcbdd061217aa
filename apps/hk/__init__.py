"""HK, the housekeeping app: collects parts of other apps' telemetry into combined packets, as its copy table says.

NASA's HK v7.0.0. Its event ids and texts, packets and table formats are NASA's. What NASA chooses when HK is compiled,
to discard combined packets that lack data, is here an argument of `run`, for a mission's own entry point.
"""

from __future__ import annotations

from .app import HK_AppMain, run
from .packets import COMMANDS, TABLES, TELEMETRY

__all__ = ["COMMANDS", "TABLES", "TELEMETRY", "HK_AppMain", "run"]
