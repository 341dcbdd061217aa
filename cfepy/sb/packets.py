"""Message ids, function codes and packet layouts of the Software Bus application (default_cfe_sb_msgstruct.h)."""

from __future__ import annotations

from cfepy.msg import Command, Layout, Telemetry

CMD_MID = 0x1803
SEND_HK_MID = 0x180B
SUB_RPT_CTRL_MID = 0x180E
HK_TLM_MID = 0x0803
STATS_TLM_MID = 0x080A
ALLSUBS_TLM_MID = 0x080D
ONESUB_TLM_MID = 0x080E

NOOP_CC = 0
RESET_COUNTERS_CC = 1
SEND_SB_STATS_CC = 2
WRITE_ROUTING_INFO_CC = 3
ENABLE_ROUTE_CC = 4
DISABLE_ROUTE_CC = 5
WRITE_PIPE_INFO_CC = 7
WRITE_MAP_INFO_CC = 8
ENABLE_SUB_REPORTING_CC = 9
DISABLE_SUB_REPORTING_CC = 10
SEND_PREV_SUBS_CC = 11

SUBSCRIPTION, UNSUBSCRIPTION = 0, 1  # SubType of a subscription report; the bus never sends the second one
SUB_ENTRIES_PER_PKT = 20
PIPES_IN_STATS = 32

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
        ("PipeDepthStats", (PIPE_DEPTH_STATS, PIPES_IN_STATS)),
    ],
)

ROUTE_COMMAND = Layout("CFE_SB_RouteCmd_Payload_t", [("MsgId", "u32"), ("Pipe", "u32"), ("Spare", "u8")])
FILE_COMMAND = Layout("CFE_SB_WriteFileInfoCmd_Payload_t", [("Filename", "char[64]")])

QOS = Layout("CFE_SB_Qos_t", [("Priority", "u8"), ("Reliability", "u8")])
ONE_SUBSCRIPTION = Layout(
    "CFE_SB_SingleSubscriptionTlm_Payload_t", [("SubType", "u8"), ("MsgId", "u32"), ("Qos", QOS), ("Pipe", "u32")]
)
SUBSCRIPTION_ENTRY = Layout("CFE_SB_SubEntries_t", [("MsgId", "u32"), ("Qos", QOS), ("Pipe", "u32")])
ALL_SUBSCRIPTIONS = Layout(
    "CFE_SB_AllSubscriptionsTlm_Payload_t",
    [
        ("PktSegment", "u32"),
        ("TotalSegments", "u32"),
        ("Entries", "u32"),
        ("Entry", (SUBSCRIPTION_ENTRY, SUB_ENTRIES_PER_PKT)),
    ],
)

ROUTING_FILE_ENTRY = Layout(
    "CFE_SB_RoutingFileEntry_t",
    [
        ("MsgId", "u32"),
        ("PipeId", "u32"),
        ("State", "u8"),
        ("MsgCnt", "u16"),
        ("AppName", "char[20]"),
        ("PipeName", "char[20]"),
    ],
)
PIPE_FILE_ENTRY = Layout(
    "CFE_SB_PipeInfoEntry_t",
    [
        ("PipeId", "u32"),
        ("AppId", "u32"),
        ("PipeName", "char[20]"),
        ("AppName", "char[20]"),
        ("MaxQueueDepth", "u16"),
        ("CurrentQueueDepth", "u16"),
        ("PeakQueueDepth", "u16"),
        ("SendErrors", "u16"),
        ("Opts", "u8"),
        ("Spare", "u8[3]"),
    ],
)
MAP_FILE_ENTRY = Layout("CFE_SB_MsgMapFileEntry_t", [("MsgId", "u32"), ("Index", "u16")])

NOOP = Command("CFE_SB_NOOP", CMD_MID, NOOP_CC, text="Answer with an event.")
RESET_COUNTERS = Command("CFE_SB_RESET_COUNTERS", CMD_MID, RESET_COUNTERS_CC, text="Set the counters to 0.")
SEND_SB_STATS = Command("CFE_SB_SEND_SB_STATS", CMD_MID, SEND_SB_STATS_CC, text="Send the statistics packet.")
WRITE_ROUTING_INFO = Command(
    "CFE_SB_WRITE_ROUTING_INFO",
    CMD_MID,
    WRITE_ROUTING_INFO_CC,
    FILE_COMMAND,
    "Write the pipes of each MsgId to a file.",
)
ENABLE_ROUTE = Command(
    "CFE_SB_ENABLE_ROUTE", CMD_MID, ENABLE_ROUTE_CC, ROUTE_COMMAND, "Let a MsgId into a pipe that subscribed to it."
)
DISABLE_ROUTE = Command(
    "CFE_SB_DISABLE_ROUTE",
    CMD_MID,
    DISABLE_ROUTE_CC,
    ROUTE_COMMAND,
    "Keep a MsgId out of a pipe that subscribed to it.",
)
WRITE_PIPE_INFO = Command(
    "CFE_SB_WRITE_PIPE_INFO",
    CMD_MID,
    WRITE_PIPE_INFO_CC,
    FILE_COMMAND,
    "Write owner, depth and use of each pipe to a file.",
)
WRITE_MAP_INFO = Command(
    "CFE_SB_WRITE_MAP_INFO",
    CMD_MID,
    WRITE_MAP_INFO_CC,
    FILE_COMMAND,
    "Write the index of each MsgId's route to a file.",
)
SEND_HK = Command("CFE_SB_SEND_HK", SEND_HK_MID, text="Send the housekeeping packet.")
ENABLE_SUB_REPORTING = Command(
    "CFE_SB_ENABLE_SUB_REPORTING",
    SUB_RPT_CTRL_MID,
    ENABLE_SUB_REPORTING_CC,
    text="Report each new subscription in a packet from now on.",
)
DISABLE_SUB_REPORTING = Command(
    "CFE_SB_DISABLE_SUB_REPORTING",
    SUB_RPT_CTRL_MID,
    DISABLE_SUB_REPORTING_CC,
    text="Stop reporting new subscriptions.",
)
SEND_PREV_SUBS = Command(
    "CFE_SB_SEND_PREV_SUBS", SUB_RPT_CTRL_MID, SEND_PREV_SUBS_CC, text="Report all subscriptions in packets."
)

HK_TLM = Telemetry("CFE_SB_HK_TLM", HK_TLM_MID, HOUSEKEEPING, "Counters, and use of the message pool.")
STATS_TLM = Telemetry("CFE_SB_STATS_TLM", STATS_TLM_MID, STATISTICS, "Use and peaks of pipes, routes and buffers.")
ALLSUBS_TLM = Telemetry(
    "CFE_SB_ALLSUBS_TLM", ALLSUBS_TLM_MID, ALL_SUBSCRIPTIONS, "A part of the subscriptions there are."
)
ONESUB_TLM = Telemetry("CFE_SB_ONESUB_TLM", ONESUB_TLM_MID, ONE_SUBSCRIPTION, "A subscription that was just made.")

COMMANDS: tuple[Command, ...] = (
    NOOP,
    RESET_COUNTERS,
    SEND_SB_STATS,
    WRITE_ROUTING_INFO,
    ENABLE_ROUTE,
    DISABLE_ROUTE,
    WRITE_PIPE_INFO,
    WRITE_MAP_INFO,
    SEND_HK,
    ENABLE_SUB_REPORTING,
    DISABLE_SUB_REPORTING,
    SEND_PREV_SUBS,
)
TELEMETRY: tuple[Telemetry, ...] = (HK_TLM, STATS_TLM, ALLSUBS_TLM, ONESUB_TLM)
