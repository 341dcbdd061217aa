"""SCH's messages and tables: message ids, commands, telemetry, layouts (sch_msg.h, sch_msgdefs.h, sch_tbldefs.h).

NASA's message ids of SCH 2.2.2 equal the ids that cFE 7 makes from the topics 0x95 to 0x98. MsgIds in the diagnostic
packet have 32 bits, as everywhere in cFE 7.
"""

from __future__ import annotations

from cfepy.msg import Command, Layout, Telemetry, local_cmd_topic_id_to_msg_id, local_tlm_topic_id_to_msg_id
from cfepy.tbl import TableType

CMD_MID = local_cmd_topic_id_to_msg_id(0x95)
SEND_HK_MID = local_cmd_topic_id_to_msg_id(0x96)
UNUSED_MID = local_cmd_topic_id_to_msg_id(0x97)
"""Stands in the entries of the message table that hold no message."""

HK_TLM_MID = local_tlm_topic_id_to_msg_id(0x97)
DIAG_TLM_MID = local_tlm_topic_id_to_msg_id(0x98)

SLOTS = 100
"""Slots, which are minor frames, of a second, which is the major frame."""

ENTRIES_PER_SLOT = 5
MAX_MESSAGES = 128
MAX_MESSAGE_SIZE = 128

UNUSED, ENABLED, DISABLED = 0, 1, 2
"""States of a schedule entry."""

ACTIVITY_SEND_MSG = 1
GROUP_NUMBER_MASK = 0xFF000000
MULTI_GROUP_MASK = 0x00FFFFFF

_ENTRY_COMMAND = Layout("SCH_EntryCmd_t", [("SlotNumber", "u16"), ("EntryNumber", "u16")])
_GROUP_COMMAND = Layout("SCH_GroupCmd_t", [("GroupData", "u32")])

HOUSEKEEPING = Layout(
    "SCH_HkPacket_t",
    [
        ("CmdCounter", "u8"),
        ("ErrCounter", "u8"),
        ("SyncToMET", "u8"),
        ("MajorFrameSource", "u8"),
        ("ScheduleActivitySuccessCount", "u32"),
        ("ScheduleActivityFailureCount", "u32"),
        ("SlotsProcessedCount", "u32"),
        ("SkippedSlotsCount", "u16"),
        ("MultipleSlotsCount", "u16"),
        ("SameSlotCount", "u16"),
        ("BadTableDataCount", "u16"),
        ("TableVerifySuccessCount", "u16"),
        ("TableVerifyFailureCount", "u16"),
        ("TablePassCount", "u32"),
        ("ValidMajorFrameCount", "u32"),
        ("MissedMajorFrameCount", "u32"),
        ("UnexpectedMajorFrameCount", "u32"),
        ("MinorFramesSinceTone", "u16"),
        ("NextSlotNumber", "u16"),
        ("LastSyncMETSlot", "u16"),
        ("IgnoreMajorFrame", "bool"),
        ("UnexpectedMajorFrame", "bool"),
    ],
)
STATE_WORDS = (SLOTS * ENTRIES_PER_SLOT + 7) // 8
DIAGNOSTICS = Layout(
    "SCH_DiagPacket_t", [("EntryStates", f"u16[{STATE_WORDS}]"), ("MsgIDs", f"u32[{SLOTS * ENTRIES_PER_SLOT}]")]
)
"""Two bits of EntryStates for each entry, the first entry in the highest bits."""

NOOP = Command("SCH_NOOP", CMD_MID, 0, text="Sends an event with the version.")
RESET = Command("SCH_RESET", CMD_MID, 1, text="Sets the counters to zero.")
ENABLE = Command("SCH_ENABLE", CMD_MID, 2, _ENTRY_COMMAND, "Enables an entry of the schedule.")
DISABLE = Command("SCH_DISABLE", CMD_MID, 3, _ENTRY_COMMAND, "Disables an entry of the schedule.")
ENABLE_GROUP = Command("SCH_ENABLE_GROUP", CMD_MID, 4, _GROUP_COMMAND, "Enables all entries of a group or of groups.")
DISABLE_GROUP = Command(
    "SCH_DISABLE_GROUP", CMD_MID, 5, _GROUP_COMMAND, "Disables all entries of a group or of groups."
)
ENABLE_SYNC = Command("SCH_ENABLE_SYNC", CMD_MID, 6, text="Trusts the major frame again after it was too noisy.")
SEND_DIAG_TLM = Command("SCH_SEND_DIAG_TLM", CMD_MID, 7, text="Sends the diagnostic packet.")
SEND_HK = Command("SCH_SEND_HK", SEND_HK_MID, text="Asks for the housekeeping packet.")

COMMANDS = (NOOP, RESET, ENABLE, DISABLE, ENABLE_GROUP, DISABLE_GROUP, ENABLE_SYNC, SEND_DIAG_TLM, SEND_HK)

HK_TLM = Telemetry("SCH_HK_TLM", HK_TLM_MID, HOUSEKEEPING, "Counters of commands, slots, activities, major frames.")
DIAG_TLM = Telemetry("SCH_DIAG_TLM", DIAG_TLM_MID, DIAGNOSTICS, "State and MsgId of every entry of the schedule.")

TELEMETRY = (HK_TLM, DIAG_TLM)

SCHEDULE_ENTRY = Layout(
    "SCH_ScheduleEntry_t",
    [
        ("EnableState", "u8"),
        ("Type", "u8"),
        ("Frequency", "u16"),
        ("Remainder", "u16"),
        ("MessageIndex", "u16"),
        ("GroupData", "u32"),
    ],
)
"""An activity happens in the seconds that leave Remainder when divided by Frequency."""

SCHEDULE_TABLE = TableType(
    "SCH.SCHED_DEF",
    Layout("SCH_Slot_t", [("Entries", (SCHEDULE_ENTRY, ENTRIES_PER_SLOT))]),
    rows=SLOTS,
    file="/cf/sch_def_schtbl.tbl",
    description="SCH schedule table",
)
"""A row is a slot; in C the table is one array of all entries, which is the same memory."""

MESSAGE_TABLE = TableType(
    "SCH.MSG_DEFS",
    Layout("SCH_MessageEntry_t", [("MessageBuffer", f"u8[{MAX_MESSAGE_SIZE}]")]),
    rows=MAX_MESSAGES,
    file="/cf/sch_def_msgtbl.tbl",
    description="SCH message definitions table",
)
"""Whole packets, header included; they are bytes here, in C 16-bit words."""
