"""SCH's state: its counters, and its two tables with their memory and their validation.

The functions that judge a table's image replace SCH_ValidateScheduleData and SCH_ValidateMessageData.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, fields
from typing import Any

from cfepy.app import Cfe
from cfepy.msg import CMD_HEADER_SIZE, HIGHEST_VALID_MSG_ID, get_msg_id, get_size
from cfepy.status import CFE_SUCCESS, CfeError

from . import events as ev
from . import packets as pk

VERSION = "2.2.1.0"
"""What the sources of SCH 2.2.2 say."""

Place = tuple[int, int]
"""Slot and entry."""

GARBAGE_ENTRY = -1
SDT_NO_FREQUENCY = -2
SDT_BAD_REMAINDER = -3
SDT_BAD_ACTIVITY = -4
SDT_BAD_MSG_INDEX = -5
SDT_BAD_ENABLE_STATE = -6
MDT_INVALID_LENGTH = -2
MDT_BAD_MSG_ID = -3


@dataclass(slots=True)
class SchCounters:
    """Counters of commands, activities and slots, as in the housekeeping packet."""

    commands_done: int = 0
    commands_failed: int = 0
    activities_done: int = 0
    activities_failed: int = 0
    slots_processed: int = 0
    skipped_slots: int = 0
    multiple_slots: int = 0
    same_slot: int = 0
    bad_table_data: int = 0
    tables_good: int = 0
    tables_bad: int = 0
    table_passes: int = 0

    def reset(self) -> None:
        """Reset the counters. The table pass counter continues, because the schedule counts by it."""
        for field in fields(self):
            if field.name != "table_passes":
                setattr(self, field.name, 0)


class Tables:
    """The schedule and the messages, in the memory of Table Services.

    Args:
        cfe: the app's handle.
        counters: get the results of validations.
    """

    def __init__(self, cfe: Cfe, counters: SchCounters) -> None:
        self._cfe = cfe
        self._counters = counters
        self._schedule = self._messages = memoryview(b"")

    # -- life ------------------------------------------------------------------------------------------------------

    def register_schedule(self) -> None:
        """Register the schedule definition table; raises CfeError."""
        self._schedule_handle = self._cfe.tbl.register(
            pk.SCHEDULE_TABLE.own_name, pk.SCHEDULE_TABLE.size, validate=self._validate_schedule
        )

    def register_messages(self) -> None:
        """Register the message definition table; raises CfeError."""
        self._messages_handle = self._cfe.tbl.register(
            pk.MESSAGE_TABLE.own_name, pk.MESSAGE_TABLE.size, validate=self._validate_messages
        )

    def load_schedule(self) -> None:
        """Load the default schedule; raises CfeError."""
        _expect_success(self._cfe.tbl.load(self._schedule_handle, pk.SCHEDULE_TABLE.file))

    def load_messages(self) -> None:
        """Load the default messages; raises CfeError."""
        _expect_success(self._cfe.tbl.load(self._messages_handle, pk.MESSAGE_TABLE.file))

    def acquire(self) -> None:
        """Let Table Services perform pending requests, then acquire both tables (SCH_AcquirePointers).

        Raises:
            CfeError: a table is not available.
        """
        tbl = self._cfe.tbl
        for handle in (self._schedule_handle, self._messages_handle):
            try:
                tbl.manage(handle)
            except CfeError:
                pass  # the table stays unchanged, and CFE_TBL has reported it to the ground
        self._schedule, _ = tbl.get_address(self._schedule_handle)
        self._messages, _ = tbl.get_address(self._messages_handle)

    def renew(self) -> None:
        """Release both tables for a moment, so that they can be updated; raises CfeError."""
        for handle in (self._schedule_handle, self._messages_handle):
            self._cfe.tbl.release_address(handle)
        self.acquire()

    def _validate_schedule(self, table: memoryview) -> int:
        verdict = judge_schedule(table)
        if verdict.status:
            text = f"Schedule tbl verify error - {verdict.fault}"
            self._cfe.evs.send_err(ev.SCHEDULE_TBL_ERR_EID, text)
        results = f"Schedule table verify results -- {verdict.counts}"
        self._cfe.evs.send_dbg(ev.SCHEDULE_TABLE_EID, results)
        return self._count(verdict)

    def _validate_messages(self, table: memoryview) -> int:
        verdict = judge_messages(table)
        if verdict.status:
            self._cfe.evs.send_err(ev.MESSAGE_TBL_ERR_EID, f"Message tbl verify err - {verdict.fault}")
        self._cfe.evs.send_dbg(ev.MESSAGE_TABLE_EID, f"Message tbl verify results - {verdict.counts}")
        return self._count(verdict)

    def _count(self, verdict: TableVerdict) -> int:
        if verdict.status:
            self._counters.tables_bad += 1
        else:
            self._counters.tables_good += 1
        return verdict.status

    # -- content ---------------------------------------------------------------------------------------------------

    def state(self, slot: int, entry: int) -> int:
        """Return the state of an entry: UNUSED, ENABLED, DISABLED, or an invalid value."""
        return self._schedule[_offset(slot, entry)]

    def is_enabled(self, slot: int, entry: int) -> bool:
        """Return whether an entry is enabled."""
        return self.state(slot, entry) == pk.ENABLED

    def entry(self, slot: int, entry: int) -> dict[str, int]:
        """Return the fields of an entry."""
        return pk.SCHEDULE_ENTRY.unpack(self._schedule, _offset(slot, entry))

    def message(self, index: int) -> memoryview:
        """Return the memory of a message."""
        at = index * pk.MAX_MESSAGE_SIZE
        return self._messages[at : at + pk.MAX_MESSAGE_SIZE]

    def members_of(self, groups: int) -> list[Place]:
        """Return the entries of a group (number in the highest byte) or of any of some multi-groups (other bits)."""
        number = groups & pk.GROUP_NUMBER_MASK
        found = []
        for place in _places():
            data = self.entry(*place)["GroupData"]
            if (number and number == data & pk.GROUP_NUMBER_MASK) or groups & data & pk.MULTI_GROUP_MASK:
                found.append(place)
        return found

    def set_states(self, places: Sequence[Place], state: int) -> None:
        """Enable or disable entries."""
        for place in places:
            self._schedule[_offset(*place)] = state
        self._cfe.tbl.modified(self._schedule_handle)

    def diagnostics(self) -> bytes:
        """Return the payload of the diagnostic packet."""
        words = [0] * pk.STATE_WORDS
        msg_ids = []
        for number, place in enumerate(_places()):
            state = self.state(*place)
            used = state in (pk.ENABLED, pk.DISABLED)
            words[number // 8] |= (state if used else 0) << (7 - number % 8) * 2
            msg_ids.append(get_msg_id(self.message(self.entry(*place)["MessageIndex"])) if used else 0)
        return pk.DIAGNOSTICS.pack(EntryStates=words, MsgIDs=msg_ids)


def _places() -> Iterable[Place]:
    return ((slot, entry) for slot in range(pk.SLOTS) for entry in range(pk.ENTRIES_PER_SLOT))


def _offset(slot: int, entry: int) -> int:
    return (slot * pk.ENTRIES_PER_SLOT + entry) * pk.SCHEDULE_ENTRY.size


def _expect_success(status: int) -> None:
    """Treat a warning as SCH does: as a failure."""
    if status != CFE_SUCCESS:
        raise CfeError(status)


@dataclass(slots=True)
class TableVerdict:
    """Counts of entries. `status` and `fault` describe the first bad one: a code below 0, and the text of the event."""

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
) -> TableVerdict:
    """Check every entry of a table.

    Args:
        entries: in table order.
        status_of: returns 0 for a good entry, None for an unused one, otherwise the error code.
        text_of: returns the event text for a bad entry and its index.
    """
    verdict = TableVerdict()
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


def judge_schedule(table: bytes | memoryview) -> TableVerdict:
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


def judge_messages(table: bytes | memoryview) -> TableVerdict:
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
