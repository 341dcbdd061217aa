"""Message ids, function codes and packet layouts of the Software Bus application (default_cfe_sb_msgstruct.h)."""

from __future__ import annotations

from cfepy.msg import Layout

CMD_MID = 0x1803
SEND_HK_MID = 0x180B
SUB_RPT_CTRL_MID = 0x180E
HK_TLM_MID = 0x0803
STATS_TLM_MID = 0x080A

NOOP_CC = 0
RESET_COUNTERS_CC = 1
SEND_SB_STATS_CC = 2
ENABLE_ROUTE_CC = 4
DISABLE_ROUTE_CC = 5

HOUSEKEEPING = Layout(
    "CFE_SB_HousekeepingTlm_Payload_t",
    [
        ("CommandCounter", "u8"),
        ("CommandErrorCounter", "u8"),
        ("NoSubscribersCounter", "u8"),
        ("MsgSendErrorCounter", "u8"),
        ("MsgReceiveErrorCounter", "u8"),
        ("InternalErrorCounter", "u8"),
        ("CreatePipeErrorCounter", "u8"),
        ("SubscribeErrorCounter", "u8"),
        ("PipeOptsErrorCounter", "u8"),
        ("DuplicateSubscriptionsCounter", "u8"),
        ("GetPipeIdByNameErrorCounter", "u8"),
        ("Spare2Align", "u8[1]"),
        ("PipeOverflowErrorCounter", "u16"),
        ("MsgLimitErrorCounter", "u16"),
        ("MemPoolHandle", "u32"),
        ("MemInUse", "u32"),
        ("UnmarkedMem", "u32"),
    ],
)

PIPE_DEPTH_STATS = Layout(
    "CFE_SB_PipeDepthStats_t",
    [
        ("PipeId", "u32"),
        ("MaxQueueDepth", "u16"),
        ("CurrentQueueDepth", "u16"),
        ("PeakQueueDepth", "u16"),
        ("Spare", "u16"),
    ],
)

STATISTICS = Layout(
    "CFE_SB_StatsTlm_Payload_t",
    [
        ("MsgIdsInUse", "u32"),
        ("PeakMsgIdsInUse", "u32"),
        ("MaxMsgIdsAllowed", "u32"),
        ("PipesInUse", "u32"),
        ("PeakPipesInUse", "u32"),
        ("MaxPipesAllowed", "u32"),
        ("MemInUse", "u32"),
        ("PeakMemInUse", "u32"),
        ("MaxMemAllowed", "u32"),
        ("SubscriptionsInUse", "u32"),
        ("PeakSubscriptionsInUse", "u32"),
        ("MaxSubscriptionsAllowed", "u32"),
        ("SBBuffersInUse", "u32"),
        ("PeakSBBuffersInUse", "u32"),
        ("MaxPipeDepthAllowed", "u32"),
        ("PipeDepthStats", (PIPE_DEPTH_STATS, 32)),
    ],
)

ROUTE_COMMAND = Layout("CFE_SB_RouteCmd_Payload_t", [("MsgId", "u32"), ("Pipe", "u32"), ("Spare", "u8")])
