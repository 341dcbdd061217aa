"""Build SCH's tables from readable terms: messages by name, activities by slot.

Scripts that make table files use it; see apps/sch/tables.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from cfepy.status import UsageError
from cfepy.tbl import TableImage

from . import packets as pk

_NO_MESSAGE = pk.UNUSED_MID.to_bytes(2, "big")


def activity(
    message: int, frequency: int = 1, remainder: int = 0, groups: int = 0, enabled: bool = True
) -> dict[str, int]:
    """Return an entry of the schedule.

    Args:
        message: index of the message in the message table, 1 to 127.
        frequency: seconds from one time to the next.
        remainder: in which of these seconds, 0 to `frequency` - 1.
        groups: number of its group in the highest byte, bits of multi-groups in the others.
        enabled: whether it is active before a command enables it.
    """
    return {
        "EnableState": pk.ENABLED if enabled else pk.DISABLED,
        "Type": pk.ACTIVITY_SEND_MSG,
        "Frequency": frequency,
        "Remainder": remainder,
        "MessageIndex": message,
        "GroupData": groups,
    }


def schedule_image(slots: Mapping[int, Sequence[Mapping[str, int]]]) -> TableImage:
    """Return the schedule definition table.

    Args:
        slots: activities by the number of their slot, 0 to 99; at most 5 each.

    Raises:
        UsageError: no such slot, too many activities, or a value that does not fit.
    """
    return pk.SCHEDULE_TABLE.image({slot: {"Entries": list(entries)} for slot, entries in slots.items()})


def message_image(messages: Mapping[int, bytes | bytearray]) -> TableImage:
    """Return the message definition table.

    Args:
        messages: whole packets by their index, 1 to 127; an even number of bytes, at most 128.

    Raises:
        UsageError: index 0, which is never sent, or a message that does not fit.
    """
    if 0 in messages:
        raise UsageError("invalid number 0, which means no message; begin with 1", field="messages[0]")
    rows: dict[int, Any] = {
        index: {"MessageBuffer": bytes(messages.get(index, _NO_MESSAGE))} for index in range(pk.MAX_MESSAGES)
    }
    unknown = [index for index in messages if index not in rows]
    if unknown:
        raise UsageError(f"unknown message {unknown[0]}; expected 1 to {pk.MAX_MESSAGES - 1}", field="messages")
    return pk.MESSAGE_TABLE.image(rows)
