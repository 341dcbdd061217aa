"""How the units of time relate; all times here are in nanoseconds."""

from __future__ import annotations

PS_PER_NS = 1_000
NS_PER_US = 1_000
NS_PER_MS = 1_000_000
NS_PER_S = 1_000_000_000
US_PER_S = 1_000_000
