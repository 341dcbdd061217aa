"""Noteworthy events of a run: events in packets of the bus, and lines about deadlines, faults and invariants.

An event is read from the packet that carries it. A line comes from the console, or from the trace alone.
"""

from __future__ import annotations

from cfepy.ground import EVENT_IDS, DecodedEvent
from cfepy.mission import Seen
from cfepy.monitors.deadline_monitor import PREFIX
from cfepy.status import CfeError, UsageError

DEADLINE, FAULT, INVARIANT = "deadline", "fault", "invariant"
_PREFIXES = {PREFIX: DEADLINE, "cfepy fault ": FAULT, "invariant ": INVARIANT}


_ENDS = ("CFE_ES_ExitApp: ", " died of an exception")
"""Parts of the lines about an application that ends."""


def event_in(msg_id: int, packet: bytes | bytearray, at_ns: int) -> DecodedEvent | None:
    """Return the event that a packet carries, or None.

    Args:
        msg_id: MsgId of the packet.
        packet: the packet with its header.
        at_ns: time of sending.
    """
    if msg_id not in EVENT_IDS:
        return None
    try:
        return DecodedEvent.of(Seen(at_ns, bytes(packet), ""))
    except (CfeError, UsageError, ValueError):
        return None  # another application sends other packets under this MsgId


def mark_of(line: str) -> tuple[str, str] | None:
    """Return the kind of a noteworthy line, and its text without the time; None for any other line."""
    for prefix, kind in _PREFIXES.items():
        if line.startswith(prefix):
            text = line.removeprefix(prefix)
            return kind, text.partition(" ")[2] if kind == DEADLINE else text
    return None


def is_end_of_app(line: str) -> bool:
    """Return whether a line of the console reports the end of an application."""
    return any(part in line for part in _ENDS)
