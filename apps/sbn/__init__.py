"""SBN, the Software Bus Network: joins the Software Buses of several processors. NASA's SBN 1.18.0.

Each SBN sends its processor's subscriptions to its peers, and forwards the messages to which they subscribe.
"""

from __future__ import annotations

from .app import SBN_AppMain, run
from .packets import COMMANDS, TABLES, TELEMETRY

__all__ = ["COMMANDS", "TABLES", "TELEMETRY", "SBN_AppMain", "run"]
