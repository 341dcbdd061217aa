"""Real packets of NASA's cFE, for tests."""

from __future__ import annotations

import json
from functools import cache
from typing import Any

from tests.layouts import DATA


@cache
def _packets() -> dict[str, list[dict[str, Any]]]:
    loaded: dict[str, list[dict[str, Any]]] = json.loads((DATA / "packets.json").read_text(encoding="utf-8"))
    return loaded


def golden_commands() -> list[dict[str, Any]]:
    """Commands: desc, mid, fc, length, hex."""
    return _packets()["commands"]


def golden_telemetry() -> list[dict[str, Any]]:
    """Telemetry: desc, mid, seq, length, time_sec, time_sub16, hex, and `event` of an event message."""
    return _packets()["telemetry"]
