"""SBN's messages and tables (sbn_msgids.h, sbn_msgdefs.h, sbn_msg.h, sbn_tbl.h, sbn_remap_tbl.h).

Answers to all requests have one MsgId. Their first byte names the request. They are packed as on the wire:
big-endian, without padding.
"""

from __future__ import annotations

from cfepy.msg import Command, Layout, Telemetry
from cfepy.tbl import TableType

from .protocol import MAX_SUBS

CMD_MID = 0x18FA
TLM_MID = 0x08FC

MAX_NETS = 16
MAX_PEERS = 16  # SBN_MAX_PEER_CNT
MAX_MODULES = 8  # SBN_MAX_MOD_CNT
MAX_FILTERS_PER_PEER = 8
REMAP_ENTRIES = 256  # SBN_REMAP_TABLE_SIZE

TASK_SEND, TASK_RECV = 1, 2
"""Bits of TaskFlags: a task waits for what is to be sent to the peer, a task waits for what comes from the net."""

REMAP_DEFAULT_IGNORE, REMAP_DEFAULT_SEND = 0, 1

_NET = Layout("SBN_NetCmd_t", [("NetIdx", "u8")])
_PEER = Layout("SBN_PeerCmd_t", [("NetIdx", "u8"), ("PeerIdx", "u8")])

NOOP = Command("SBN_NOOP", CMD_MID, 0, text="Does nothing.")
HK = Command("SBN_HK", CMD_MID, 10, text="Asks for SBN's own housekeeping.")
HK_NET = Command("SBN_HK_NET", CMD_MID, 11, _NET, "Asks for the housekeeping of a net.")
HK_PEER = Command("SBN_HK_PEER", CMD_MID, 12, _PEER, "Asks for the housekeeping of a peer.")
HK_PEERSUBS = Command("SBN_HK_PEERSUBS", CMD_MID, 13, _PEER, "Requests the subscriptions of a peer.")
HK_MYSUBS = Command("SBN_HK_MYSUBS", CMD_MID, 14, text="Requests the subscriptions of this processor.")
HK_RESET = Command("SBN_HK_RESET", CMD_MID, 15, text="Sets all counters to zero.")
HK_RESET_PEER = Command("SBN_HK_RESET_PEER", CMD_MID, 16, _PEER, "Sets the counters of a peer to zero.")
SCH_WAKEUP = Command("SBN_SCH_WAKEUP", CMD_MID, 100, text="Wakes SBN up, for a scheduler.")
TBL = Command(
    "SBN_TBL",
    CMD_MID,
    110,
    Layout("CFE_TBL_NotifyCmd_Payload_t", [("Parameter", "u32")]),
    "Says that a table has changed; Table Services send it.",
)

COMMANDS = (NOOP, HK, HK_NET, HK_PEER, HK_PEERSUBS, HK_MYSUBS, HK_RESET, HK_RESET_PEER, SCH_WAKEUP, TBL)

HOUSEKEEPING = Layout(
    "SBN_HkTlm_Payload_t",
    [("CC", "u8"), ("CmdCnt", "u16"), ("CmdErrCnt", "u16"), ("SubCnt", "u16"), ("NetCnt", "u16")],
    on_the_wire=True,
)
NET = Layout("SBN_HkNet_Payload_t", [("CC", "u8"), ("ProtocolIdx", "u8"), ("PeerCnt", "u16")], on_the_wire=True)
PEER = Layout(
    "SBN_HkPeer_Payload_t",
    [
        ("CC", "u8"),
        ("ProcessorID", "u32"),
        *((f"Last{way}{part}", "u32") for way in ("Send", "Recv") for part in ("Seconds", "Microseconds")),
        *((count, "u16") for count in ("SendCnt", "RecvCnt", "SendErrCnt", "RecvErrCnt", "SubCnt")),
    ],
    on_the_wire=True,
)
PEER_SUBS = Layout(
    "SBN_HkPeerSubs_Payload_t",
    [("CC", "u8"), ("NetIdx", "u16"), ("PeerIdx", "u16"), ("SubCnt", "u16"), ("Subs", f"u32[{MAX_SUBS}]")],
    on_the_wire=True,
)
MY_SUBS = Layout(
    "SBN_HkMySubs_Payload_t", [("CC", "u8"), ("SubCnt", "u16"), ("Subs", f"u32[{MAX_SUBS}]")], on_the_wire=True
)

HK_NET_TLM = Telemetry("SBN_HK_NET_TLM", TLM_MID, NET, "A net.", HK_NET.code)
HK_PEER_TLM = Telemetry(
    "SBN_HK_PEER_TLM", TLM_MID, PEER, "A peer: its messages, and when the last ones went and came.", HK_PEER.code
)
HK_PEERSUBS_TLM = Telemetry(
    "SBN_HK_PEERSUBS_TLM", TLM_MID, PEER_SUBS, "What a peer has subscribed to.", HK_PEERSUBS.code
)
HK_MYSUBS_TLM = Telemetry(
    "SBN_HK_MYSUBS_TLM", TLM_MID, MY_SUBS, "What this processor has subscribed to.", HK_MYSUBS.code
)
HK_TLM = Telemetry(
    "SBN_HK_TLM",
    TLM_MID,
    HOUSEKEEPING,
    "SBN's counters, and how many subscriptions and nets it has.",
    HK.code,
    (HK_NET_TLM, HK_PEER_TLM, HK_PEERSUBS_TLM, HK_MYSUBS_TLM),
)

TELEMETRY = (HK_TLM,)
"""The others are variants of it."""

MODULE_ENTRY = Layout(
    "SBN_Module_Entry_t",
    [("Name", "char[16]"), ("LibFileName", "char[64]"), ("LibSymbol", "char[20]"), ("BaseEID", "u16")],
)
PEER_ENTRY = Layout(
    "SBN_Peer_Entry_t",
    [
        ("ProcessorID", "u32"),
        ("SpacecraftID", "u32"),
        ("NetNum", "u8"),
        ("ProtocolName", "char[16]"),
        ("Filters", f"char[{MAX_FILTERS_PER_PEER}][16]"),
        ("Address", "char[48]"),
        ("TaskFlags", "u32"),
    ],
)
CONF = Layout(
    "SBN_ConfTbl_t",
    [
        ("ProtocolModules", (MODULE_ENTRY, MAX_MODULES)),
        ("ProtocolCnt", "u8"),
        ("FilterModules", (MODULE_ENTRY, MAX_MODULES)),
        ("FilterCnt", "u8"),
        ("Peers", (PEER_ENTRY, MAX_PEERS)),
        ("PeerCnt", "u16"),
    ],
)
CONF_TABLE = TableType("SBN.SBN_ConfTbl", CONF, file="/cf/sbn_conf_tbl.tbl", description="SBN Configuration Table")
"""Who the processors are, this one among them, and how they are reached."""

REMAP_ENTRY = Layout(
    "SBN_RemapTblEntry_t", [("ProcessorID", "u32"), ("SpacecraftID", "u32"), ("FromMID", "u32"), ("ToMID", "u32")]
)
REMAP = Layout("SBN_RemapTbl_t", [("RemapDefaultFlag", "u32"), ("Entries", (REMAP_ENTRY, REMAP_ENTRIES))])
REMAP_TABLE = TableType("SBN.SBN_RemapTbl", REMAP, file="/cf/sbn_remap_tbl.tbl", description="SBN Remap Table")
"""Which MsgIds change on the way to and from a peer; with a ToMID of 0 a message does not go there."""

TABLES = (CONF_TABLE, REMAP_TABLE)
