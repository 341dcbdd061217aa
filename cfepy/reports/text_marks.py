"""Which lines of a run stand out: what deadlines, faults and invariants say, on the console or in the trace alone."""

from __future__ import annotations

from cfepy.mission.deadline_monitor import PREFIX

DEADLINE, FAULT, INVARIANT = "deadline", "fault", "invariant"
_PREFIXES = {PREFIX: DEADLINE, "cfepy fault ": FAULT, "invariant ": INVARIANT}


def mark_of(line: str) -> tuple[str, str] | None:
    """What kind of line it is, and what it says without the time; None for any other."""
    for prefix, kind in _PREFIXES.items():
        if line.startswith(prefix):
            text = line.removeprefix(prefix)
            return kind, text.partition(" ")[2] if kind == DEADLINE else text
    return None
