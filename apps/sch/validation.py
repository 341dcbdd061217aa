"""When SCH's tables are good (SCH_ValidateScheduleData, SCH_ValidateMessageData)."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass
from typing import Any

from cfepy.msg import CMD_HEADER_SIZE, HIGHEST_VALID_MSG_ID, get_msg_id, get_size

from . import packets as pk

GARBAGE_ENTRY = -1
SDT_NO_FREQUENCY = -2
SDT_BAD_REMAINDER = -3
SDT_BAD_ACTIVITY = -4
SDT_BAD_MSG_INDEX = -5
SDT_BAD_ENABLE_STATE = -6
MDT_INVALID_LENGTH = -2
MDT_BAD_MSG_ID = -3


@dataclass(slots=True)
class Verdict:
    """Entries counted; `status` and `fault` are those of the first bad one: a code below 0, and what the event says."""

    good: int = 0
    bad: int = 0
    unused: int = 0
    status: int = 0
    fault: str = ""

    @property
    def counts(self) -> str:
        """The counts, as the events have them."""
        return f"good[{self.good}] bad[{self.bad}] unused[{self.unused}]"


def judge(
    entries: Iterable[Any], status_of: Callable[[Any], int | None], text_of: Callable[[int, Any], str]
) -> Verdict:
    """Look at every entry of a table.

    Args:
        entries: in table order.
        status_of: 0 for a good entry, None for an unused one, else what is wrong.
        text_of: what the event says of the bad entry of an index.
    """
    verdict = Verdict()
    for index, entry in enumerate(entries):
        status = status_of(entry)
        if status is None:
            verdict.unused += 1
        elif status == 0:
            verdict.good += 1
        else:
            verdict.bad += 1
            if not verdict.status:
                verdict.status, verdict.fault = status, text_of(index, entry)
    return verdict


def judge_schedule(table: bytes | memoryview) -> Verdict:
    """Judge a schedule definition table."""
    size = pk.SCHEDULE_ENTRY.size
    entries = (pk.SCHEDULE_ENTRY.unpack(table, at) for at in range(0, pk.SCHEDULE_TABLE.size, size))
    return judge(entries, _schedule_status, _schedule_text)


def _schedule_status(entry: dict[str, int]) -> int | None:
    if entry["EnableState"] == pk.UNUSED:
        return GARBAGE_ENTRY if any(entry.values()) else None
    if entry["EnableState"] not in (pk.ENABLED, pk.DISABLED):
        return SDT_BAD_ENABLE_STATE
    if not entry["Frequency"]:
        return SDT_NO_FREQUENCY
    if entry["Remainder"] >= entry["Frequency"]:
        return SDT_BAD_REMAINDER
    if entry["Type"] != pk.ACTIVITY_SEND_MSG:
        return SDT_BAD_ACTIVITY
    return 0 if 0 < entry["MessageIndex"] < pk.MAX_MESSAGES else SDT_BAD_MSG_INDEX


def _schedule_text(index: int, entry: dict[str, int]) -> str:
    what = f"idx[{index}] ena[{entry['EnableState']}] typ[{entry['Type']}] fre[{entry['Frequency']}]"
    return f"{what} rem[{entry['Remainder']}] msg[{entry['MessageIndex']}] grp[0x{entry['GroupData']:08X}]"


def judge_messages(table: bytes | memoryview) -> Verdict:
    """Judge a message definition table."""
    size = pk.MAX_MESSAGE_SIZE
    return judge(
        (table[at : at + size] for at in range(0, pk.MESSAGE_TABLE.size, size)), _message_status, _message_text
    )


def _message_status(message: bytes | memoryview) -> int | None:
    msg_id, size = get_msg_id(message), get_size(message)
    if msg_id == pk.UNUSED_MID:
        return GARBAGE_ENTRY if any(message[CMD_HEADER_SIZE:]) else None
    if msg_id > HIGHEST_VALID_MSG_ID:
        return MDT_BAD_MSG_ID
    return 0 if CMD_HEADER_SIZE <= size <= pk.MAX_MESSAGE_SIZE and size % 2 == 0 else MDT_INVALID_LENGTH


def _message_text(index: int, message: bytes | memoryview) -> str:
    return f"idx[{index}] mid[0x{get_msg_id(message):X}] len[{get_size(message)}] buf[0]"
