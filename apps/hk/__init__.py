"""HK, the housekeeping app: collects parts of other apps' telemetry into combined packets, as its copy table says.

NASA's HK v7.0.0. Its event ids and texts, packets and table formats are NASA's.
"""

from __future__ import annotations

from .app import HK_AppMain

__all__ = ["HK_AppMain"]
