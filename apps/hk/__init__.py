"""HK, the housekeeping app: collects parts of other apps' telemetry into combined packets, defined by its copy table.

NASA's HK v7.0.0. Its event ids and texts, packets and table formats are NASA's. NASA's compile-time option to discard
combined packets that lack data is an argument of `run` here, for a mission's own entry point.
"""

from __future__ import annotations

from dataclasses import replace

from .app import HK_AppMain, run
from .combined import combined_telemetry
from .copy_table import find_fault
from .packets import COMMANDS, COPY_TABLE, RUNTIME_TABLE, TELEMETRY

TABLES = (replace(COPY_TABLE, fault=find_fault, telemetry=combined_telemetry), RUNTIME_TABLE)

__all__ = ["COMMANDS", "TABLES", "TELEMETRY", "HK_AppMain", "run"]
