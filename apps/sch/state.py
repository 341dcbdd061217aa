"""What SCH keeps: its counters, and its two tables with the memory they are in."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, fields

from cfepy.app import Cfe
from cfepy.msg import get_msg_id
from cfepy.status import CFE_SUCCESS, CfeError

from . import events as ev
from . import packets as pk
from .validation import Verdict, judge_messages, judge_schedule

VERSION = "2.2.1.0"
"""What the sources of SCH 2.2.2 say."""

Place = tuple[int, int]
"""Slot and entry."""


@dataclass(slots=True)
class Counters:
    """What housekeeping tells of commands, activities and slots."""

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
        """Start anew; the passes go on, since the schedule counts by them."""
        for field in fields(self):
            if field.name != "table_passes":
                setattr(self, field.name, 0)


class Tables:
    """The schedule and the messages, in the memory of Table Services.

    Args:
        cfe: the app's handle.
        counters: get the results of validations.
    """

    def __init__(self, cfe: Cfe, counters: Counters) -> None:
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
        """Let Table Services do what is pending, then take hold of both tables (SCH_AcquirePointers).

        Raises:
            CfeError: a table cannot be had.
        """
        tbl = self._cfe.tbl
        for handle in (self._schedule_handle, self._messages_handle):
            try:
                tbl.manage(handle)
            except CfeError:
                pass  # the table stays as it is, and CFE_TBL has told the ground
        self._schedule, _ = tbl.get_address(self._schedule_handle)
        self._messages, _ = tbl.get_address(self._messages_handle)

    def renew(self) -> None:
        """Let go of both tables for a moment, so that updates can be done; raises CfeError."""
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

    def _count(self, verdict: Verdict) -> int:
        if verdict.status:
            self._counters.tables_bad += 1
        else:
            self._counters.tables_good += 1
        return verdict.status

    # -- content ---------------------------------------------------------------------------------------------------

    def state(self, slot: int, entry: int) -> int:
        """State of an entry: UNUSED, ENABLED, DISABLED, or something that nobody should have written."""
        return self._schedule[_offset(slot, entry)]

    def is_enabled(self, slot: int, entry: int) -> bool:
        """Whether an entry is to be done."""
        return self.state(slot, entry) == pk.ENABLED

    def entry(self, slot: int, entry: int) -> dict[str, int]:
        """The fields of an entry."""
        return pk.SCHEDULE_ENTRY.unpack(self._schedule, _offset(slot, entry))

    def message(self, index: int) -> memoryview:
        """The memory of a message."""
        at = index * pk.MAX_MESSAGE_SIZE
        return self._messages[at : at + pk.MAX_MESSAGE_SIZE]

    def members_of(self, groups: int) -> list[Place]:
        """Entries of a group, or of any of some multi-groups: the number is in the highest byte, the rest are bits."""
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
        """The payload of the diagnostic packet."""
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
