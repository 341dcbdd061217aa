/* Commands and telemetry of CFE_SB: function codes, payloads, packets. */
#ifndef CFEPY_SB_MESSAGES_H
#define CFEPY_SB_MESSAGES_H

#include "message_kinds.h"

CFEPY_C_BEGIN

enum CFE_SB_FunctionCode_ {
    CFE_SB_FunctionCode_NOOP = 0, CFE_SB_FunctionCode_RESET_COUNTERS = 1, CFE_SB_FunctionCode_SEND_SB_STATS = 2,
    CFE_SB_FunctionCode_WRITE_ROUTING_INFO = 3, CFE_SB_FunctionCode_ENABLE_ROUTE = 4,
    CFE_SB_FunctionCode_DISABLE_ROUTE = 5, CFE_SB_FunctionCode_WRITE_PIPE_INFO = 7,
    CFE_SB_FunctionCode_WRITE_MAP_INFO = 8, CFE_SB_FunctionCode_ENABLE_SUB_REPORTING = 9,
    CFE_SB_FunctionCode_DISABLE_SUB_REPORTING = 10, CFE_SB_FunctionCode_SEND_PREV_SUBS = 11
};

#define CFE_SB_NOOP_CC                  0
#define CFE_SB_RESET_COUNTERS_CC        1
#define CFE_SB_SEND_SB_STATS_CC         2
#define CFE_SB_WRITE_ROUTING_INFO_CC    3
#define CFE_SB_ENABLE_ROUTE_CC          4
#define CFE_SB_DISABLE_ROUTE_CC         5
#define CFE_SB_WRITE_PIPE_INFO_CC       7
#define CFE_SB_WRITE_MAP_INFO_CC        8
#define CFE_SB_ENABLE_SUB_REPORTING_CC  9
#define CFE_SB_DISABLE_SUB_REPORTING_CC 10
#define CFE_SB_SEND_PREV_SUBS_CC        11

typedef struct CFE_SB_WriteFileInfoCmd_Payload {
    char Filename[CFE_MISSION_MAX_PATH_LEN];
} CFE_SB_WriteFileInfoCmd_Payload_t;

typedef struct CFE_SB_RouteCmd_Payload {
    CFE_SB_MsgId_t MsgId;
    CFE_SB_PipeId_t Pipe;
    uint8 Spare;
} CFE_SB_RouteCmd_Payload_t;

typedef struct CFE_SB_HousekeepingTlm_Payload {
    uint8 CommandCounter, CommandErrorCounter, NoSubscribersCounter, MsgSendErrorCounter, MsgReceiveErrorCounter,
        InternalErrorCounter, CreatePipeErrorCounter, SubscribeErrorCounter, PipeOptsErrorCounter,
        DuplicateSubscriptionsCounter, GetPipeIdByNameErrorCounter, Spare2Align[1];
    uint16 PipeOverflowErrorCounter, MsgLimitErrorCounter;
    CFE_ES_MemHandle_t MemPoolHandle;
    uint32 MemInUse, UnmarkedMem;
} CFE_SB_HousekeepingTlm_Payload_t;

typedef struct CFE_SB_PipeDepthStats {
    CFE_SB_PipeId_t PipeId;
    uint16 MaxQueueDepth, CurrentQueueDepth, PeakQueueDepth, Spare;
} CFE_SB_PipeDepthStats_t;

typedef struct CFE_SB_PipeInfoEntry {
    CFE_SB_PipeId_t PipeId;
    CFE_ES_AppId_t AppId;
    char PipeName[CFE_MISSION_MAX_API_LEN], AppName[CFE_MISSION_MAX_API_LEN];
    uint16 MaxQueueDepth, CurrentQueueDepth, PeakQueueDepth, SendErrors;
    uint8 Opts, Spare[3];
} CFE_SB_PipeInfoEntry_t;

typedef struct CFE_SB_StatsTlm_Payload {
    uint32 MsgIdsInUse, PeakMsgIdsInUse, MaxMsgIdsAllowed, PipesInUse, PeakPipesInUse, MaxPipesAllowed, MemInUse,
        PeakMemInUse, MaxMemAllowed, SubscriptionsInUse, PeakSubscriptionsInUse, MaxSubscriptionsAllowed,
        SBBuffersInUse, PeakSBBuffersInUse, MaxPipeDepthAllowed;
    CFE_SB_PipeDepthStats_t PipeDepthStats[32];
} CFE_SB_StatsTlm_Payload_t;

typedef struct CFE_SB_RoutingFileEntry {
    CFE_SB_MsgId_t MsgId;
    CFE_SB_PipeId_t PipeId;
    uint8 State;
    uint16 MsgCnt;
    char AppName[CFE_MISSION_MAX_API_LEN], PipeName[CFE_MISSION_MAX_API_LEN];
} CFE_SB_RoutingFileEntry_t;

typedef struct CFE_SB_MsgMapFileEntry {
    CFE_SB_MsgId_t MsgId;
    CFE_SB_RouteId_Atom_t Index;
} CFE_SB_MsgMapFileEntry_t;

typedef struct CFE_SB_SingleSubscriptionTlm_Payload {
    uint8 SubType;
    CFE_SB_MsgId_t MsgId;
    CFE_SB_Qos_t Qos;
    CFE_SB_PipeId_t Pipe;
} CFE_SB_SingleSubscriptionTlm_Payload_t;

typedef struct CFE_SB_SubEntries {
    CFE_SB_MsgId_t MsgId;
    CFE_SB_Qos_t Qos;
    CFE_SB_PipeId_t Pipe;
} CFE_SB_SubEntries_t;

typedef struct CFE_SB_AllSubscriptionsTlm_Payload {
    uint32 PktSegment, TotalSegments, Entries;
    CFE_SB_SubEntries_t Entry[20];
} CFE_SB_AllSubscriptionsTlm_Payload_t;


CFEPY_COMMAND(CFE_SB_NoopCmd);
CFEPY_COMMAND(CFE_SB_ResetCountersCmd);
CFEPY_COMMAND(CFE_SB_EnableSubReportingCmd);
CFEPY_COMMAND(CFE_SB_DisableSubReportingCmd);
CFEPY_COMMAND(CFE_SB_SendSbStatsCmd);
CFEPY_COMMAND(CFE_SB_SendPrevSubsCmd);
CFEPY_COMMAND(CFE_SB_SendHkCmd);
CFEPY_COMMAND_WITH(CFE_SB_WriteRoutingInfoCmd, CFE_SB_WriteFileInfoCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_SB_WritePipeInfoCmd, CFE_SB_WriteFileInfoCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_SB_WriteMapInfoCmd, CFE_SB_WriteFileInfoCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_SB_EnableRouteCmd, CFE_SB_RouteCmd_Payload_t);
CFEPY_COMMAND_WITH(CFE_SB_DisableRouteCmd, CFE_SB_RouteCmd_Payload_t);
CFEPY_TELEMETRY(CFE_SB_HousekeepingTlm, CFE_SB_HousekeepingTlm_Payload_t);
CFEPY_TELEMETRY(CFE_SB_StatsTlm, CFE_SB_StatsTlm_Payload_t);
CFEPY_TELEMETRY(CFE_SB_SingleSubscriptionTlm, CFE_SB_SingleSubscriptionTlm_Payload_t);
CFEPY_TELEMETRY(CFE_SB_AllSubscriptionsTlm, CFE_SB_AllSubscriptionsTlm_Payload_t);

CFEPY_C_END

#endif
