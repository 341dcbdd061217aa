"""Events decoded from packets: cFE's Event Services send each event as telemetry, long or short (CFE_EVS)."""

from __future__ import annotations

from typing import NamedTuple

from cfepy.evs import CRITICAL, DEBUG, ERROR, INFORMATION
from cfepy.evs import packets as evs
from cfepy.mission import Seen
from cfepy.msg import TLM_HEADER_SIZE
from cfepy.units import NS_PER_S

EVENT_TYPES = {"DEBUG": DEBUG, "INFORMATION": INFORMATION, "ERROR": ERROR, "CRITICAL": CRITICAL}
EVENT_IDS = frozenset((evs.LONG_EVENT_MSG_MID, evs.SHORT_EVENT_MSG_MID))


class DecodedEvent(NamedTuple):
    """A decoded event; the short format has no text. `at_ns` is the virtual time at which it was sent."""

    at_ns: int
    app: str
    event_id: int
    event_type: int
    text: str

    @classmethod
    def of(cls, seen: Seen) -> DecodedEvent:
        """Return the event in a packet of EVS."""
        packet_id = evs.PACKET_ID.unpack(seen.packet, TLM_HEADER_SIZE)
        is_long = seen.msg_id == evs.LONG_EVENT_MSG_MID
        text = evs.LONG_EVENT.unpack(seen.packet, TLM_HEADER_SIZE)["Message"] if is_long else ""
        return cls(seen.at_ns, packet_id["AppName"], packet_id["EventID"], packet_id["EventType"], text)

    @property
    def type_name(self) -> str:
        """DEBUG, INFORMATION, ERROR or CRITICAL."""
        names = {number: name for name, number in EVENT_TYPES.items()}
        return names.get(self.event_type, str(self.event_type))

    def __str__(self) -> str:
        return f'{self.app} {self.event_id} {self.type_name} "{self.text}" at {self.at_ns / NS_PER_S:.3f}'
