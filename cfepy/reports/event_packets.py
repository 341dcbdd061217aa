"""Events of the Event Services, read from the packets that carry them over the bus."""

from __future__ import annotations

from typing import NamedTuple

from cfepy.evs import packets as pk
from cfepy.evs.events import CRITICAL, DEBUG, ERROR, INFORMATION
from cfepy.msg import TLM_HEADER_SIZE
from cfepy.status import CfeError, UsageError

TYPES = {DEBUG: "DEBUG", INFORMATION: "INFORMATION", ERROR: "ERROR", CRITICAL: "CRITICAL"}


class Event(NamedTuple):
    """An event: virtual time in ns, who reports it, its number, its type by name, its text."""

    at_ns: int
    app: str
    number: int
    type: str
    text: str


def event_in(msg_id: int, packet: bytes | bytearray, at_ns: int) -> Event | None:
    """The event that a packet carries, None when it carries none; one of the short format has no text.

    Args:
        msg_id: of the packet.
        packet: with its header.
        at_ns: when it was sent.
    """
    layout = {pk.LONG_EVENT_MSG_MID: pk.LONG_EVENT, pk.SHORT_EVENT_MSG_MID: pk.SHORT_EVENT}.get(msg_id)
    if layout is None:
        return None
    try:
        fields = layout.unpack(bytes(packet), TLM_HEADER_SIZE)
    except (CfeError, UsageError, ValueError):
        return None  # somebody else sends something under this MsgId
    who = fields["PacketID"]
    kind = TYPES.get(who["EventType"], str(who["EventType"]))
    return Event(at_ns, str(who["AppName"]), who["EventID"], kind, str(fields.get("Message", "")))
