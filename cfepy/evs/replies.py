"""What Event Services answers to commands: a DEBUG event when it did one, an ERROR event when it refused.

Imports no other service.
"""

from __future__ import annotations

from cfepy.evs import events as ev
from cfepy.evs.apps import ALL_TYPES
from cfepy.evs.core import EventCore


class Replies:
    """Sends the events; the methods return what a command's handler returns then.

    Args:
        core: the way of an event.
    """

    def __init__(self, core: EventCore) -> None:
        self._core = core

    def done(self, event_id: int, text: str) -> bool:
        """Confirm a command; True."""
        self._core.send_own(event_id, ev.DEBUG, text)
        return True

    def refuse(self, event_id: int, text: str) -> bool:
        """Say why a command is not done; False."""
        self._core.send_own(event_id, ev.ERROR, text)
        return False

    def is_mask(self, mask: int, code: int) -> bool:
        """Whether bits name event types or ports, of which there are four; an event when not (EVS_IsInvalidBitMask)."""
        if 0 < mask <= ALL_TYPES:
            return True
        return self.refuse(ev.ERR_INVALID_BITMASK_EID, f"Bit Mask = 0x{mask:08x} out of range: CC = {code}")
