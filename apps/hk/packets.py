"""HK's messages and tables: ids, function codes, layouts (hk_msgstruct.h, hk_tblstruct.h, hk_internal_cfg.h).

Ground tools read `COMMANDS`, `TELEMETRY` and `TABLES`.
"""

from __future__ import annotations

from cfepy.msg import Command, Layout, Telemetry, local_cmd_topic_id_to_msg_id, local_tlm_topic_id_to_msg_id
from cfepy.tbl import TableType

CMD_MID = local_cmd_topic_id_to_msg_id(0x9A)
SEND_HK_MID = local_cmd_topic_id_to_msg_id(0x9B)
SEND_COMBINED_PKT_MID = local_cmd_topic_id_to_msg_id(0x9C)
HK_TLM_MID = local_tlm_topic_id_to_msg_id(0x9B)
COMBINED_PKT1_MID = local_tlm_topic_id_to_msg_id(0x9C)

COPY_TABLE_ENTRIES = 128
MAX_COMBINED_PACKET_SIZE = 1500

SEND_COMBINED_PKT_PAYLOAD = Layout("HK_SendCombinedPkt_Payload_t", [("OutMsgToSend", "u32")])

HOUSEKEEPING = Layout(
    "HK_HkTlm_Payload_t",
    [
        ("CmdCounter", "u8"),
        ("ErrCounter", "u8"),
        ("Padding", "u16"),
        ("CombinedPacketsSent", "u16"),
        ("MissingDataCtr", "u16"),
        ("MemPoolHandle", "u32"),
    ],
)

COPY_TABLE_ENTRY = Layout(
    "HK_CopyTableEntry_t",
    [
        ("InputMid", "u32"),
        ("InputOffset", "u16"),
        ("OutputMid", "u32"),
        ("OutputOffset", "u16"),
        ("NumBytes", "u16"),
    ],
)
"""Offsets count from the first byte of the packet, header included."""

RUNTIME_TABLE_ENTRY = Layout(
    "HK_RuntimeTableEntry_t", [("OutputPktAddr", "u64"), ("InputMidSubscribed", "u8"), ("DataPresent", "u8")]
)

NOOP = Command("HK_NOOP", CMD_MID, 0, text="Answer with an event.")
RESET_COUNTERS = Command("HK_RESET_COUNTERS", CMD_MID, 1, text="Set the counters to 0.")
SEND_HK = Command("HK_SEND_HK", SEND_HK_MID, text="Send the housekeeping packet, and manage the tables.")
SEND_COMBINED_PKT = Command(
    "HK_SEND_COMBINED_PKT",
    SEND_COMBINED_PKT_MID,
    payload=SEND_COMBINED_PKT_PAYLOAD,
    text="Send a combined packet of the copy table.",
)

COMMANDS = (NOOP, RESET_COUNTERS, SEND_HK, SEND_COMBINED_PKT)

HK_TLM = Telemetry("HK_HK_TLM", HK_TLM_MID, HOUSEKEEPING, "HK's counters.")

TELEMETRY = (HK_TLM,)

COPY_TABLE = TableType(
    "HK.CopyTable", COPY_TABLE_ENTRY, COPY_TABLE_ENTRIES, "/cf/hk_cpy_tbl.tbl", description="HK Copy Tbl"
)
"""What is copied from where to where."""

RUNTIME_TABLE = TableType("HK.RuntimeTable", RUNTIME_TABLE_ENTRY, COPY_TABLE_ENTRIES, description="HK Runtime Tbl")
"""What HK made of each entry of the copy table; it can only be dumped."""
