"""HK's messages and tables: message ids, function codes, layouts (hk_msg.h, hk_tbl.h, hk_platform_cfg.h)."""

from __future__ import annotations

from cfepy.msg import Layout, local_cmd_topic_id_to_msg_id, local_tlm_topic_id_to_msg_id

CMD_MID = local_cmd_topic_id_to_msg_id(0x9A)
SEND_HK_MID = local_cmd_topic_id_to_msg_id(0x9B)
SEND_COMBINED_PKT_MID = local_cmd_topic_id_to_msg_id(0x9C)
HK_TLM_MID = local_tlm_topic_id_to_msg_id(0x9B)
COMBINED_PKT1_MID = local_tlm_topic_id_to_msg_id(0x9C)

NOOP_CC = 0
RESET_COUNTERS_CC = 1

COPY_TABLE_ENTRIES = 128
MAX_COMBINED_PACKET_SIZE = 1500

SEND_COMBINED_PKT = Layout("HK_SendCombinedPkt_Payload", [("OutMsgToSend", "u32")])

HOUSEKEEPING = Layout(
    "HK_HkTlm_Payload",
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
    "HK_CopyTableEntry",
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
    "HK_RuntimeTableEntry", [("OutputPktAddr", "u64"), ("InputMidSubscribed", "u8"), ("DataPresent", "u8")]
)
