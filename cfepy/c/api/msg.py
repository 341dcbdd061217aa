"""CFE_MSG_*Action: what the bus does to a message where it starts and where it arrives.

All else of CFE_MSG only looks at the bytes of a message, and is the engine's (`engine/natives_msg.c`).
"""

from __future__ import annotations

from typing import TYPE_CHECKING

from cfepy import msg
from cfepy.status import CFE_MSG_BAD_ARGUMENT

if TYPE_CHECKING:
    from cfepy.c.calls import Declarations
    from cfepy.c.runtime import CRuntime

BAD = CFE_MSG_BAD_ARGUMENT
SIZE_FIELD = slice(4, 6)


def declare(api: Declarations, c: CRuntime) -> None:
    """Add the functions; see `cfepy.c.api`."""
    memory, stamp = c.memory, c.handle.time.stamp

    def originate(message: int, _: int, is_acceptable: int) -> None:
        size = int.from_bytes(memory.peek(message, msg.PRIMARY_HEADER_SIZE)[SIZE_FIELD], "big") + 7
        packet = bytearray(memory.peek(message, size))
        msg.origination_action(packet, stamp())
        memory.poke(message, packet)
        memory.poke(is_acceptable, b"\1")

    def verify(message: int, _: int, is_acceptable: int) -> None:
        memory.poke(is_acceptable, b"\1")

    api.add("CFE_MSG_OriginationAction", "PQP", originate, BAD)
    api.add("CFE_MSG_VerificationAction", "PQP", verify, BAD)
