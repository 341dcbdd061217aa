"""How many nanoseconds, the unit of all times here, make a larger unit. Imports nothing of cfepy."""

from __future__ import annotations

NS_PER_US = 1_000
NS_PER_MS = 1_000_000
NS_PER_S = 1_000_000_000
